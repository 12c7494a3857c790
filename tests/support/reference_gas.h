// A gas simulated by brute force, which can be told to err as engines do: what audits are tried on.
#pragma once

#include <cstdint>
#include <vector>

#include "needlework/simulation.h"

namespace needlework::test {

/// What goes wrong, at every `every`-th occasion. The history goes on consistently from there.
struct Fault {
  enum Kind {
    none,
    drop,         ///< a contact does not happen; the needles pass through each other
    delay,        ///< a collision happens later by `amount` of time, or earlier if negative
    blind,        ///< the side after touching is lost: the pair's return, if it comes, is not seen
    repeat,       ///< the side after touching is taken wrong: the pair collides again at once
    restitution,  ///< the impulse is too large by the share `amount`
  };
  Kind kind = none;
  int every = 1;
  double amount = 0;
};

struct ReferenceRun {
  State initial;
  std::vector<Collision> collisions;
  double end = 0;   ///< time
  int planted = 0;  ///< faults
};

/// Epochs of the collisions' times, which are plain doubles: so long that no run is longer.
inline constexpr double reference_epoch = 32;

/// Runs the scene from its drawn state until so many collisions have happened. Every pair of a few
/// dozen needles is predicted anew for each of them.
ReferenceRun run_reference(const Scene& scene, int collisions, const Fault& fault);

}  // namespace needlework::test
