// A calendar chosen at run time. The event loop is compiled once for all of them: it makes some ten
// calls a collision, among some ten thousand instructions.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "src/calendar/calendar.h"

namespace needlework {

/// Who is given the new event of a needle.
class EventSink {
 public:
  /// `by_block`: whether the block in set() matters.
  explicit EventSink(bool by_block) : needs_block(by_block) {}
  virtual ~EventSink() = default;
  /// Replaces the event of event.owner, who is in this block now.
  virtual void set(const Event& event, BlockIndex block) = 0;

  const bool needs_block;
};

/// Any model of the concept Calendar, by the same promises.
class AnyCalendar : public EventSink {
 public:
  using EventSink::EventSink;

  virtual const char* name() const = 0;
  virtual const Event& top() const = 0;
  virtual const Event& of(Needle i) const = 0;
  virtual Needle likely_next() const = 0;
  /// Begins again, with n needles whose events never happen. Frees the memory held before first.
  virtual void reset(std::size_t n, const Clock& clock, std::size_t blocks) = 0;
};

/// A calendar of type C behind that interface.
template <Calendar C>
class CalendarOf final : public AnyCalendar {
 public:
  CalendarOf() : AnyCalendar(C::by_block), calendar_(0, Clock(), 1) {}

  /// The calendar itself, for those who need more of it than every calendar has.
  C& get() { return calendar_; }

  const char* name() const override { return C::name; }
  const Event& top() const override { return calendar_.top(); }
  const Event& of(Needle i) const override { return calendar_.of(i); }
  Needle likely_next() const override { return calendar_.likely_next(); }
  void set(const Event& event, BlockIndex block) override { calendar_.set(event, block); }
  void reset(std::size_t n, const Clock& clock, std::size_t blocks) override {
    calendar_ = C(0, clock, 1);
    calendar_ = C(n, clock, blocks);
  }

 private:
  C calendar_;
};

/// The calendar of this name, for no needles: reset() it. Throws InputError for a name that does
/// not exist.
std::unique_ptr<AnyCalendar> make_calendar(const std::string& name);

}  // namespace needlework
