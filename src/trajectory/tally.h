// What a thread adds up while it makes events happen. Sums, so that those of several threads can be
// added, in any order.
#pragma once

#include <cstdint>

#include "needlework/counters.h"
#include "src/physics/clock.h"
#include "src/trajectory/trajectory_hash.h"

namespace needlework {

struct Tally {
  std::uint64_t collisions = 0, tc_collisions = 0;
  std::int64_t energy = 0;  ///< change of the energy, in quanta of the window
  TrajectoryHash hash;
  Counters counters;
  Time instant;                  ///< of the last collision
  std::uint64_t at_instant = 0;  ///< collisions at that instant

  /// Moves what `other` has into this one, but for its instant: what follows is later.
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
