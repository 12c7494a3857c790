// The lengths of needles, as the searches read them.
#pragma once

#include <cmath>
#include <concepts>

#include "src/physics/gas.h"

namespace needlework {

/// What tells a search half the length of each needle's axis, and how far the needle reaches from
/// its centre [L]: in the event loop the model, for which both are constants where all needles have
/// length 1. Centres of two needles in contact are not farther apart than both reach.
template <class L>
concept Lengths = requires(const L& lengths, Needle i) {
  { lengths.half_length(i) } -> std::same_as<double>;
  { lengths.reach(i) } -> std::same_as<double>;
};

/// Lengths from the bodies, which is right for any gas.
struct BodyLengths {
  const Gas& gas;
  double half_length(Needle i) const { return gas.half_length(i); }
  double reach(Needle i) const { return gas.reach(i); }
};

static_assert(Lengths<BodyLengths>);

/// The least power of two that no needle is longer than, from end to end: the unit of length of the
/// SIMD kernels. [L]
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
