// Pairs whose needles lie and move close to one plane, where the contact function is small for
// long.
#pragma once

#include <cmath>

#include "tests/support/kernel_pair.h"
#include "tests/support/random.h"

namespace needlework::test {

/// A pair of which all that points out of the plane z = 0 is of the order of `tilt`, and whose
/// centres move with about `speed`. With a tilt of 0 the contact function is 0 for ever.
inline KernelPair nearly_planar(Random& random, double tilt, double speed) {
  const auto needle = [&] {
    const double angle = random.uniform(0, 6.3);
    return flight(
        {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), tilt * random.normal()},
        {std::cos(angle), std::sin(angle), tilt * random.normal()},
        {speed * random.normal(), speed * random.normal(), speed * tilt * random.normal()},
        {tilt * random.normal(), tilt * random.normal(), random.normal()});
  };
  KernelPair pair;
  pair.first = needle();
  pair.second = needle();
  return pair;
}

}  // namespace needlework::test
