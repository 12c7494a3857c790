// How far threads are in time, told to each other: what they have not seen of each other can only
// be judged as long as they are near.
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

#include "src/engine/done_log.h"
#include "src/engine/patience.h"

namespace needlework {

class Fronts {
 public:
  /// `sight`: how far from an event others' events are seen. [L]
  Fronts(std::size_t threads, double sight) : fronts_(threads), sight_(sight) {}

  /// Of a new phase; `expected`: a guess at the speed of its fastest needle. [L/time]
  void begin(double expected) {
    expected_ = expected;
    for (Front& front : fronts_) {
      front.next = 0;
      front.latest = 0;
      front.fastest = 0;
    }
  }
  /// The speed of the fastest needle of an event, before that.
  double fastest() const {
    double out = 0;
    for (const Front& front : fronts_) out = std::max(out, front.fastest.load());
    return out;
  }

  /// The earliest event that a thread has.
  void tell_next(std::size_t thread, TimeKey key) {
    look_away();
    fronts_[thread].next.store(key, std::memory_order_relaxed);
  }
  /// An event that a thread is to do, before it does; of the two told by threads at once, whichever
  /// asks reach_of_later() last knows of the other. Returns whether the thread has done no later
  /// one.
  bool tell_taken(std::size_t thread, TimeKey key, double speed) {
    Front& mine = fronts_[thread];
    const bool in_order = key > mine.latest;
    if (speed > mine.fastest) mine.fastest = speed;
    if (in_order) mine.latest = key;
    return in_order;
  }

  /// Whether a thread is so far behind an event that it could not be told who may have met
  /// meanwhile; or nearly so, as threads go on while one looks. The hindmost is never ahead.
  bool is_too_far_ahead(TimeKey key) const {
    look_away();
    TimeKey hindmost = key;
    double fastest = expected_;
    for (const Front& front : fronts_) {
      hindmost = std::min(hindmost, front.next.load(std::memory_order_relaxed));
      fastest = std::max(fastest, front.fastest.load(std::memory_order_relaxed));
    }
    constexpr double room = 2;
    return hindmost < key && is_out_of_sight(DoneLog::reach(hindmost, key, room * 2 * fastest));
  }

  /// How far needles of later events may be that a needle of an event can have met before them,
  /// with this speed since. 0: there are none. `in_order`: none of the thread itself. [L]
  double reach_of_later(std::size_t thread, TimeKey key, double speed, bool in_order) const {
    TimeKey latest = 0;
    double fastest = speed;
    for (std::size_t t = 0; t < fronts_.size(); ++t) {
      if (t == thread && in_order) continue;
      latest = std::max(latest, fronts_[t].latest.load());
      fastest = std::max(fastest, fronts_[t].fastest.load());
    }
    return latest < key ? 0 : DoneLog::reach(key, latest, speed + fastest);
  }
  bool is_out_of_sight(double distance) const { return !(distance < sight_); }

 private:
  struct alignas(128) Front {
    std::atomic<TimeKey> next = 0, latest = 0;
    std::atomic<double> fastest = 0;
    Front() = default;
    Front(Front&&) noexcept {}
  };
  std::vector<Front> fronts_;
  double sight_;
  double expected_ = 0;
};

}  // namespace needlework
