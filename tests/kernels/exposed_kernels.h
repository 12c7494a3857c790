// The parts of the SIMD kernels that near_needles.h does not show, on every instruction set, for
// tests of them alone. Those of the twin with their types are in exposed_simd.h.
#pragma once

#include "kernels/near_needles.h"

namespace needlework::kernels {

/// A step of the bracket for the first pair of the columns: the bounds that it relies on, and the
/// shares of a span `h` before and after a sample at time `s` in which the pair surely does not
/// meet.
struct ExposedStep {
  float bend, coil, tips_bend;
  float before, after;
};
ExposedStep exposed_step(Isa isa, const Seeker& seeker, const PairColumns& pairs, float s, float h);

struct RoughResults {
  float error;  ///< by which the others may be off, of themselves
  float quotient, root, inverse_root, length;
};
/// a / b, the root of a and 1 over it, and the length of (a, b, 0), by rough operations.
RoughResults rough_results(Isa isa, float a, float b);

/// Intervals of time of pairs, one in each lane that is taken (1, else 0).
struct ExposedIntervals {
  float low[16], high[16], taken[16];
  std::uint32_t pair[16];
};
/// spread() of as many as are taken.
ExposedIntervals exposed_spread(Isa isa, const ExposedIntervals& all);
/// add() of some to others.
ExposedIntervals exposed_add(Isa isa, const ExposedIntervals& all, const ExposedIntervals& more);

}  // namespace needlework::kernels
