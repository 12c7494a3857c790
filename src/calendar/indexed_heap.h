// A calendar as an indexed 4-ary heap, in which events are replaced in place.
#pragma once

#include "src/calendar/calendar.h"
#include "src/calendar/needle_heap.h"

namespace needlework {

/// `set` is O(log n), `top` O(1). 84 bytes per needle.
class IndexedHeap {
 public:
  static constexpr const char* name = "indexed-heap";
  static constexpr bool by_cell = false;

  IndexedHeap(std::size_t n, const Clock& clock, std::size_t) : events_(n, clock), heap_(n) {
    for (Needle i{0}; i < n; ++i) heap_.set(i, events_.key(i), events_);
  }

  bool empty() const { return heap_.empty(); }
  const Event& top() const { return events_[heap_.top()]; }
  const Event& of(Needle i) const { return events_[i]; }
  Needle likely_next() const { return heap_.top(); }
  void set(const Event& event, CellIndex) { heap_.set(event.owner, events_.put(event), events_); }

 private:
  EventTable events_;
  NeedleHeap heap_;
};

}  // namespace needlework
