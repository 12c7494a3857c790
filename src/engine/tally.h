// Totals that a thread accumulates while it processes events. They are sums, so that those of
// several threads can be added in any order.
#pragma once

#include <cstdint>

#include "needlework/counters.h"
#include "src/physics/clock.h"
#include "src/trajectory/trajectory_hash.h"

namespace needlework {

struct Tally {
  std::uint64_t collisions = 0, tc_collisions = 0;
  std::uint64_t energy = 0;  ///< change of the total energy, in quanta of the windows, modulo 2^64
  TrajectoryHash hash;
  Counters counters;
  Time instant;                  ///< time of the last collision
  std::uint64_t at_instant = 0;  ///< number of collisions at that time

  /// Moves the sums of `other` into this object. Not its last instant, because later events have
  /// later times.
  void take(Tally& other) {
    collisions += other.collisions;
    tc_collisions += other.tc_collisions;
    energy += other.energy;
    hash.add(other.hash);
    counters += other.counters;
    other = {};
  }
};

}  // namespace needlework
