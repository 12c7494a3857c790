// The lengths of needles, as the searches read them.
#pragma once

#include <cmath>

#include "src/physics/gas.h"

namespace needlework {

/// Half the length of needle i. [L]
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
