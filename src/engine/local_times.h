// How far each thread is in simulated time. An event is checked against later events that other
// threads have already processed near it. This works only while the threads are close in time, so
// each publishes its progress, and one that is too far ahead waits.
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

#include "src/engine/backoff.h"
#include "src/engine/causality_log.h"

namespace needlework {

class LocalTimes {
 public:
  /// `sight`: how far from an event a thread may look for later events that others have processed;
  /// Phase::sight_of_log, not the `sight` of Phase. [L]
  LocalTimes(std::size_t threads, double sight, double longest = 1)
      : times_(threads), sight_(sight), longest_(longest) {}

  /// Starts a new phase. `expected` is an estimate of the largest speed of its needles. [L/time]
  void begin(double expected) {
    expected_ = expected;
    for (LocalTime& each : times_) {
      each.next = 0;
      each.latest = 0;
      each.fastest = 0;
    }
  }
  /// The largest speed of a needle of any event of the phase, just before the event. [L/time]
  double fastest() const {
    double out = 0;
    for (const LocalTime& each : times_) out = std::max(out, each.fastest.load());
    return out;
  }

  /// Publishes the earliest event that a thread has still to process.
  void publish_next(std::size_t thread, TimeKey key) {
    random_pause();
    times_[thread].next.store(key, std::memory_order_relaxed);
  }
  /// What has been published of the events before one event, as its thread saw it.
  struct Seen {
    bool in_order;  ///< the event is later than all that its own thread has processed in the phase
    // Of all events in the phase of other threads and, unless in order, of its own:
    TimeKey latest;  ///< the latest
    double fastest;  ///< the largest speed of a needle, just before its event [L/time]
  };
  /// Publishes an event before the thread processes it, then looks at those of the others. If two
  /// threads publish at the same time, at least one of them sees the event of the other.
  Seen publish_event(std::size_t thread, TimeKey key, double speed) {
    LocalTime& mine = times_[thread];
    Seen seen{key > mine.latest, 0, 0};
    if (speed > mine.fastest) mine.fastest = speed;
    if (seen.in_order) mine.latest = key;
    for (std::size_t t = 0; t < times_.size(); ++t) {
      if (t == thread && seen.in_order) continue;
      seen.latest = std::max(seen.latest, times_[t].latest.load());
      seen.fastest = std::max(seen.fastest, times_[t].fastest.load());
    }
    return seen;
  }

  /// The earliest event that another thread has still to process.
  TimeKey next_of_others(std::size_t thread) const {
    random_pause();
    TimeKey out = ~TimeKey{0};
    for (std::size_t t = 0; t < times_.size(); ++t) {
      if (t != thread) out = std::min(out, times_[t].next.load(std::memory_order_relaxed));
    }
    return out;
  }
  /// Whether the earliest event that is still to be processed is so far behind another one that in
  /// the time between them needles could come together from farther apart than `sight`, where the
  /// check does not look. Counts with twice the way that they can fly, because threads go on
  /// meanwhile.
  bool is_too_far_ahead(TimeKey key, TimeKey hindmost) const {
    if (hindmost >= key) return false;
    double fastest = expected_;
    for (const LocalTime& each : times_) {
      fastest = std::max(fastest, each.fastest.load(std::memory_order_relaxed));
    }
    constexpr double room = 2;
    return is_out_of_sight(CausalityLog::reach(hindmost, key, room * 2 * fastest, longest_));
  }

  /// Take a needle that has an event at `key` and flies with `speed` afterwards, and all later
  /// events that had been published before. Returns a distance: needles of those events that were
  /// farther away cannot have met this one in between. Returns 0 if there are no later events. [L]
  double reach_of_later(const Seen& seen, TimeKey key, double speed) const {
    if (seen.latest < key) return 0;
    return CausalityLog::reach(key, seen.latest, speed + std::max(speed, seen.fastest), longest_);
  }
  bool is_out_of_sight(double distance) const { return !(distance < sight_); }

 private:
  struct alignas(128) LocalTime {
    std::atomic<TimeKey> next = 0, latest = 0;
    std::atomic<double> fastest = 0;
    LocalTime() = default;
    LocalTime(LocalTime&&) noexcept {}
  };
  std::vector<LocalTime> times_;
  double sight_;
  double longest_;  ///< length of the longest needles [L]
  double expected_ = 0;
};

}  // namespace needlework
