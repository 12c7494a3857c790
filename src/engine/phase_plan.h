// How long threads go on before they meet: a phase.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "src/physics/clock.h"

namespace needlework {

/// Plans phases from how those before them went. A phase that was undone is done again by one
/// thread, and those after it are shorter.
class PhasePlan {
 public:
  /// Collisions of a phase: about so many, and those that make one worth it.
  static constexpr double usual_most = 0x1p15, usual_least = 0x1p6;

  PhasePlan(const Clock& clock, double least) : clock_(clock), least_(least) {}

  struct Stretch {
    Time end;
    bool together;  ///< whether all threads take part
  };

  /// What is known before a stretch.
  struct Outlook {
    Time next;    ///< the next event, before which nothing happens
    Time end;     ///< of the longest stretch that is asked for
    Time ready;   ///< till when threads may go on together
    double left;  ///< collisions to the end of the run
    double rate;  ///< of collisions in thermal flight [1/time]
  };

  Stretch next(const Outlook& at) const {
    if (at.next < alone_until_) return {std::min(at.end, alone_until_), false};
    const Time end = std::min(at.end, at.ready);
    // An end by collisions is approached in smaller and smaller phases, to undo little.
    const double most = std::min(most_, at.left / 2);
    const double rate = pace_ * at.rate, to_end = rate * clock_.difference(end, at.next);
    const Time part = to_end > most ? std::min(end, clock_.add(at.next, most / rate)) : end;
    // Too little to share, or too short to be told from nothing.
    if (std::min(most, to_end) < least_ || !(at.next < part)) return {at.end, false};
    return {part, true};
  }

  /// Collisions of one thread at which a phase is broken off.
  std::uint64_t most_of_a_thread() const {
    return static_cast<std::uint64_t>(2 * most_ + 4 * usual_least);
  }

  /// After any stretch: where needles slide along each other there are many more collisions than
  /// in thermal flight.
  void counted(double collisions, double thermal) {
    if (collisions >= least_) pace_ = std::clamp(collisions / thermal, 1e-3, fastest_pace);
  }
  void kept() {
    most_ = std::min(2 * most_, usual_most);
    in_vain_ = 0;
  }
  void had_too_many() { pace_ = std::min(4 * pace_, fastest_pace); }
  /// The phase between these times was undone: one thread does it. Phases undone again and again,
  /// as those in which threads can hardly be kept together, are tried more and more seldom.
  void undone(Time from, Time end) {
    alone_until_ = clock_.add(end, in_vain_ * clock_.difference(end, from));
    in_vain_ = std::min(2 * in_vain_ + 1, most_in_vain);
    most_ = std::max(most_ / 4, least_);
  }

 private:
  static constexpr double most_in_vain = 1000, fastest_pace = 1e9;

  const Clock& clock_;
  double least_;
  double most_ = usual_most;  ///< collisions of a phase, less where some were undone
  double pace_ = 1;           ///< collisions there are, over those of thermal flight
  double in_vain_ = 0;        ///< lengths of a phase to do alone after one that was undone
  Time alone_until_;          ///< till then one thread does what was undone
};

}  // namespace needlework
