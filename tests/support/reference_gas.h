// A gas simulated by brute force, with errors on request as an engine may make them. It serves to
// test audits.
#pragma once

#include <cstdint>
#include <vector>

#include "needlework/simulation.h"

namespace needlework::test {

/// An error that is made on every `every`-th occasion. The history continues consistently from
/// there.
struct Fault {
  enum Kind {
    none,
    drop,         ///< a contact is skipped; the needles pass through each other
    delay,        ///< a collision happens later by `amount` of time, or earlier if negative
    blind,        ///< the side after touching is lost: if the pair returns, that is not seen
    repeat,       ///< the side after touching is wrong: the pair collides again at once
    restitution,  ///< the impulse is too large by the fraction `amount`
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

/// Epoch length of the collisions' times, which are plain doubles: longer than any run.
inline constexpr double reference_epoch = 32;

/// Runs the scene from its drawn state for this number of collisions. After each of them every
/// pair of a few dozen needles is predicted again.
ReferenceRun run_reference(const Scene& scene, int collisions, const Fault& fault);

}  // namespace needlework::test
