// What is counted of contacts in which needles slide on each other.
#pragma once

#include <cstdint>

#include "src/trajectory/exact_total.h"

namespace needlework {

/// Sums, so that those of several threads can be added in any order.
struct SlidingTally {
  std::uint64_t entered = 0;
  std::uint64_t by_force = 0, by_tip = 0, by_strike = 0;  ///< ended
  std::uint64_t crowded = 0;  ///< collisions whose epsilon was raised, as a third needle was near
  std::uint64_t steps = 0;    ///< of the motion in contact
  ExactTotal time;            ///< in contact, of all pairs [time]

  template <class Archive>
  friend void transfer(Archive& archive, SlidingTally& tally) {
    archive(tally.entered, tally.by_force, tally.by_tip, tally.by_strike, tally.crowded,
            tally.steps, tally.time);
  }
  /// Another event has cut a contact that has lasted so long.
  void cut(double lasted) {
    ++by_strike;
    time.add(lasted);
  }
  void take(SlidingTally& other) {
    entered += other.entered;
    by_force += other.by_force;
    by_tip += other.by_tip;
    by_strike += other.by_strike;
    crowded += other.crowded;
    steps += other.steps;
    time.take(other.time);
  }
};

}  // namespace needlework
