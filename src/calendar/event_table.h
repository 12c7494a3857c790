// The events of all needles, and short keys by which calendars compare them.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/calendar/event.h"
#include "src/memory/large_array.h"
#include "src/memory/prefetch.h"

namespace needlework {

/// Orders events by time with the precision of a double; Time::never() has the greatest key. If
/// two keys are equal, the events are compared in full.
using TimeKey = std::uint64_t;

/// One event for each needle, in 64 bytes, so that an event is one cache line.
class EventTable {
 public:
  EventTable(std::size_t n, const Clock& clock) : slots_(n), clock_(clock) {
    for (std::size_t i = 0; i < n; ++i) slots_[i].event.owner = Needle(i);
  }

  std::size_t size() const { return slots_.size(); }
  const Event& operator[](Needle i) const { return slots_[i].event; }
  const Clock& clock() const { return clock_; }

  /// Replaces the event of its owner and returns the key.
  TimeKey put(const Event& event) {
    slots_[event.owner].event = event;
    return key_of(event.time);
  }
  TimeKey key(Needle i) const { return key_of(slots_[i].event.time); }
  TimeKey key_of(const Time& time) const { return key_of(time, clock_); }
  static TimeKey key_of(const Time& time, const Clock& clock) {
    // Numbers >= 0 have the same order as their bits, read as integers. Adding 0.0 turns -0 into
    // 0.
    return std::bit_cast<std::uint64_t>(clock.since_start(time) + 0.0);
  }

  static double time_of(TimeKey key) { return std::bit_cast<double>(key); }

  /// The full order of events, for events with equal keys.
  bool before(Needle a, Needle b) const { return slots_[a].event < slots_[b].event; }

  /// Prefetches an event that will soon be on top.
  void prefetch(Needle i) const { needlework::prefetch(&slots_[i]); }

 private:
  struct alignas(64) Slot {
    Event event;
  };

  LargeArray<Slot> slots_;
  Clock clock_;
};

}  // namespace needlework
