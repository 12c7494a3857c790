// Plans how long threads work between two meetings: the length of a phase.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "src/physics/clock.h"

namespace needlework {

/// Plans phases from how previous ones went. After a phase that was rolled back, and which one
/// thread repeats, phases are shorter.
class PhasePlan {
 public:
  /// Usual number of collisions of each thread in a phase. Measured on two threads: with four times
  /// as many, 1e5 needles take 1.3 % more time, as the logs outgrow the cache; with half as many,
  /// 1e6 needles take 1.8 % more.
  static constexpr double usual_share = 0x1p12;
  /// Usual least number of all threads together, below which they are not worth it.
  static constexpr double usual_least = 0x1p6;

  /// `most`, `least`: number of collisions in a phase, of all threads.
  PhasePlan(const Clock& clock, double most, double least)
      : clock_(clock), usual_most_(most), least_(least) {}

  struct Stretch {
    Time end;
    bool together;  ///< whether all threads take part
  };

  /// What is known before a stretch of time is planned.
  struct Outlook {
    Time next;             ///< time of the next event
    Time end;              ///< latest end of the stretch
    Time ready;            ///< latest time to which several threads can work
    double left;           ///< collisions until the run ends
    double rate;           ///< expected number of collisions in thermal flight [1/time]
    bool together = true;  ///< whether all threads are preferred to one
    double most = std::numeric_limits<double>::infinity();  ///< collisions of the stretch
  };

  Stretch next(const Outlook& at) const {
    if (at.next < alone_until_) return {std::min(at.end, alone_until_), false};
    const Time end = at.together ? std::min(at.end, at.ready) : at.end;
    // A limit on collisions is approached in ever shorter phases, so that little has to be rolled
    // back.
    const double rate = pace_ * at.rate, to_end = rate * clock_.difference(end, at.next);
    const double most =
        at.together ? std::min({most_, std::max(at.most, least_), at.left / 2}) : at.most;
    const Time part = to_end > most ? std::min(end, clock_.add(at.next, most / rate)) : end;
    // Too few collisions to share, or a stretch so short that rounding hides it.
    const bool too_few = at.together && std::min(most, to_end) < least_;
    if (too_few || !(at.next < part)) return {at.end, false};
    return {part, at.together};
  }

  /// Number of collisions of one thread at which a phase is abandoned.
  std::uint64_t most_of_a_thread() const {
    return static_cast<std::uint64_t>(2 * most_ + 4 * usual_least);
  }

  /// To be called after each stretch with its number of collisions. Where needles slide along each
  /// other there are many more than in thermal flight.
  void counted(double collisions, double thermal) {
    if (collisions >= least_) pace_ = std::clamp(collisions / thermal, 1e-3, fastest_pace);
  }
  void kept() {
    most_ = std::min(2 * most_, usual_most_);
    in_vain_ = 0;
  }
  /// To be called when the phase between these times had too many collisions. The next ones are
  /// shorter. Where that does not help, as in a collapse at one instant, one thread works alone.
  void had_too_many(Time from, Time end) {
    if (pace_ == fastest_pace) return rolled_back(from, end);
    pace_ = std::min(4 * pace_, fastest_pace);
  }
  /// To be called when the phase between these times was rolled back. One thread repeats it. If
  /// phases are rolled back repeatedly, because several threads can hardly be synchronised, they
  /// are tried more and more rarely.
  void rolled_back(Time from, Time end) {
    alone_until_ = clock_.add(end, in_vain_ * clock_.difference(end, from));
    in_vain_ = std::min(2 * in_vain_ + 1, most_in_vain);
    most_ = std::max(most_ / 4, least_);
  }

 private:
  static constexpr double most_in_vain = 1000, fastest_pace = 1e9;

  const Clock& clock_;
  double usual_most_, least_;
  double most_ = usual_most_;  ///< collisions in a phase; fewer after phases that were rolled back
  double pace_ = 1;            ///< number of collisions, relative to thermal flight
  double in_vain_ = 0;         ///< time that one thread works alone after a rolled back phase, in
                               ///< lengths of the phase
  Time alone_until_;           ///< time until which one thread works alone
};

}  // namespace needlework
