// A calendar as a tournament between all needles.
#pragma once

#include "src/calendar/event_table.h"
#include "src/calendar/winner_tree.h"

namespace needlework {

/// `set` is O(log n), and O(1) on average for an event that does not come up next; `top` O(1).
/// 74 bytes a needle.
class Tournament {
 public:
  static constexpr const char* name = "tournament";

  Tournament(std::size_t n, const Clock& clock)
      : events_(n, clock), tree_(n, events_.key_of(Time::never())) {}

  bool empty() const { return events_.size() == 0; }
  const Event& top() const { return events_[tree_.winner()]; }
  const Event& of(Needle i) const { return events_[i]; }
  Needle soon() const {
    const Needle i = tree_.second();
    events_.prefetch(i);
    return i;
  }

  void set(const Event& event) {
    tree_.update(
        event.owner, events_.put(event), [&](Needle a, Needle b) { return events_.before(a, b); },
        [&](Needle i) { events_.prefetch(i); });
  }

 private:
  EventTable events_;
  WinnerTree tree_;
};

}  // namespace needlework
