// The lengths of needles, as the searches read them.
#pragma once

#include <cmath>

#include "src/physics/gas.h"

namespace needlework {

/// Half the length of needle i. [L]
///
/// It is read from the table of species even if all needles have length 1, because a search is
/// compiled once for all effects. A constant in its place changes the instructions per collision
/// by less than 0.1 % with the SIMD searches, which read it when a needle is placed. It would save
/// 0.6 % (dilute) to 1.4 % (dense) with `linked-lists`, which reads it for each candidate.
inline double half_length_of(const Gas& gas, Needle i) {
  return gas.bodies[gas.records[i].species].half_length;
}

/// The least power of two that no needle is longer than: the unit of length of the SIMD kernels.
/// [L]
inline double unit_of_length(const Gas& gas) {
  int exponent;
  const double mantissa = std::frexp(gas.longest, &exponent);  // in [1/2, 1)
  return std::ldexp(1, mantissa == 0.5 ? exponent - 1 : exponent);
}

/// Needles per cube of the longest one: what the searches choose their sizes by.
inline double reduced_density(const Gas& gas) {
  return gas.density() * (gas.longest * gas.longest * gas.longest);
}

}  // namespace needlework
