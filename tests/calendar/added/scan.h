// The smallest calendar: it looks through all needles for the next event. A test adds it as
// src/calendar/README.md says.
#pragma once

#include "src/calendar/calendar.h"
#include "src/calendar/event_table.h"

namespace needlework {

/// `set` is O(n) for the needle whose event is next, else O(1). 64 bytes per needle.
class Scan {
 public:
  static constexpr const char* name = "scan";
  static constexpr bool by_cell = false;

  Scan(std::size_t n, const Clock& clock, std::size_t) : events_(n, clock) {}

  bool empty() const { return events_.size() == 0; }
  const Event& top() const { return events_[first_]; }
  const Event& of(Needle i) const { return events_[i]; }
  Needle likely_next() const { return first_; }
  void set(const Event& event, CellIndex) {
    events_.put(event);
    if (event.owner != first_) {
      if (events_.before(event.owner, first_)) first_ = event.owner;
      return;
    }
    for (Needle i{0}; i < events_.size(); ++i) {
      if (events_.before(i, first_)) first_ = i;
    }
  }

 private:
  EventTable events_;
  Needle first_{0};
};

}  // namespace needlework
