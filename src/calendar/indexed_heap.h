// A calendar as a 4-ary heap of needles with the place of each kept, so that an event can be
// replaced where it stands.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "src/calendar/event.h"

namespace needlework {

/// Holds exactly one event for each of n needles.
class IndexedHeap {
 public:
  static constexpr const char* name = "indexed-heap";

  explicit IndexedHeap(std::size_t n) : events_(n), heap_(n), place_(n) {
    for (std::size_t i = 0; i < n; ++i) {
      events_[i].owner = static_cast<Needle>(i);
      heap_[i] = place_[i] = static_cast<Needle>(i);
    }
  }

  bool empty() const { return heap_.empty(); }
  /// The earliest event. The calendar is not empty.
  const Event& top() const { return events_[heap_[0]]; }
  const Event& of(Needle i) const { return events_[i]; }

  /// Replaces the event of its owner.
  void set(const Event& event) {
    events_[event.owner] = event;
    if (!sift_up(place_[event.owner])) sift_down(place_[event.owner]);
  }

 private:
  static constexpr std::size_t arity = 4;

  bool before(std::size_t a, std::size_t b) const { return events_[heap_[a]] < events_[heap_[b]]; }
  void exchange(std::size_t a, std::size_t b) {
    std::swap(heap_[a], heap_[b]);
    place_[heap_[a]] = static_cast<Needle>(a);
    place_[heap_[b]] = static_cast<Needle>(b);
  }
  bool sift_up(std::size_t at) {
    bool moved = false;
    while (at > 0) {
      const std::size_t parent = (at - 1) / arity;
      if (!before(at, parent)) break;
      exchange(at, parent);
      at = parent;
      moved = true;
    }
    return moved;
  }
  void sift_down(std::size_t at) {
    for (;;) {
      const std::size_t first = at * arity + 1;
      if (first >= heap_.size()) return;
      std::size_t least = first;
      const std::size_t last = std::min(first + arity, heap_.size());
      for (std::size_t child = first + 1; child < last; ++child) {
        if (before(child, least)) least = child;
      }
      if (!before(least, at)) return;
      exchange(at, least);
      at = least;
    }
  }

  std::vector<Event> events_;
  std::vector<Needle> heap_;   ///< needles in heap order
  std::vector<Needle> place_;  ///< of each needle in the heap
};

}  // namespace needlework
