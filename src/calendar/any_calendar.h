// A calendar that is chosen at run time. The event loop is compiled once for all calendars: it
// makes about ten virtual calls per collision, among some fifty thousand instructions.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "src/calendar/calendar.h"

namespace needlework {

/// Receives the new event of a needle.
class EventSink {
 public:
  /// `by_cell`: whether the cell passed to set() matters.
  explicit EventSink(bool by_cell) : needs_cell(by_cell) {}
  virtual ~EventSink() = default;
  /// Replaces the event of event.owner, which is now in this cell.
  virtual void set(const Event& event, CellIndex cell) = 0;
  /// Prefetches what set() of an event of needle i in this cell will access.
  virtual void prefetch(Needle i, CellIndex cell) const = 0;

  const bool needs_cell;
};

/// The interface of all models of the concept Calendar, with the same promises.
class AnyCalendar : public EventSink {
 public:
  using EventSink::EventSink;

  virtual const char* name() const = 0;
  virtual const Event& top() const = 0;
  virtual const Event& of(Needle i) const = 0;
  virtual Needle likely_next() const = 0;
  /// Starts again with n needles whose events never happen. Frees the old memory first.
  virtual void reset(std::size_t n, const Clock& clock, std::size_t cells) = 0;
};

/// Implements that interface by a calendar of type C.
template <Calendar C>
class CalendarOf final : public AnyCalendar {
 public:
  CalendarOf() : AnyCalendar(C::by_cell), calendar_(0, Clock(), 1) {}

  /// The calendar itself, for code that needs more of it than every calendar offers.
  C& get() { return calendar_; }

  const char* name() const override { return C::name; }
  const Event& top() const override { return calendar_.top(); }
  const Event& of(Needle i) const override { return calendar_.of(i); }
  Needle likely_next() const override { return calendar_.likely_next(); }
  void set(const Event& event, CellIndex cell) override { calendar_.set(event, cell); }
  void prefetch(Needle i, CellIndex cell) const override {
    if constexpr (requires { calendar_.prefetch(i, cell); }) calendar_.prefetch(i, cell);
  }
  void reset(std::size_t n, const Clock& clock, std::size_t cells) override {
    calendar_ = C(0, clock, 1);
    calendar_ = C(n, clock, cells);
  }

 private:
  C calendar_;
};

/// Makes the calendar of this name, with no needles; reset() it before use. Throws InputError for
/// an unknown name.
std::unique_ptr<AnyCalendar> make_calendar(const std::string& name);

}  // namespace needlework
