// A calendar as the standard library's heap: replaced events stay in it until they are on top.
#pragma once

#include <queue>
#include <utility>
#include <vector>

#include "src/calendar/calendar.h"
#include "src/calendar/event_table.h"

namespace needlework {

/// The simple choice, against which the others are measured. `set` is O(log n) amortised, `top`
/// O(1). 196 bytes per needle, which allows for as many replaced events as present ones; 324 while
/// replaced events are being removed.
class LazyHeap {
 public:
  static constexpr const char* name = "lazy-heap";
  static constexpr bool by_cell = false;

  LazyHeap(std::size_t n, const Clock& clock, std::size_t) : events_(n, clock), version_(n) {
    rebuild();
  }

  bool empty() const { return version_.empty(); }
  const Event& top() const { return heap_.top().event; }
  const Event& of(Needle i) const { return events_[i]; }

  /// Number of entries, replaced events included.
  std::size_t entries() const { return heap_.size(); }

  Needle likely_next() const { return top().owner; }
  void set(const Event& event, CellIndex) {
    events_.put(event);
    heap_.push({event, ++version_[event.owner]});
    if (heap_.size() > 2 * version_.size() + 8) rebuild();
    while (is_stale(heap_.top())) heap_.pop();
  }

 private:
  // Replaced events must keep their position in the heap, so each entry has its own copy.
  struct Entry {
    Event event;
    std::uint32_t version;  ///< of the owner's event; if it differs, the event has been replaced
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const { return b.event < a.event; }
  };

  bool is_stale(const Entry& entry) const { return entry.version != version_[entry.event.owner]; }

  // Removes all replaced events. O(n).
  void rebuild() {
    std::vector<Entry> entries;
    entries.reserve(2 * version_.size() + 9);
    for (Needle i{0}; i < version_.size(); ++i) entries.push_back({events_[i], version_[i]});
    heap_ = Heap(Later{}, std::move(entries));
  }

  using Heap = std::priority_queue<Entry, std::vector<Entry>, Later>;
  EventTable events_;
  std::vector<std::uint32_t> version_;
  Heap heap_;
};

}  // namespace needlework
