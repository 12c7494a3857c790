// The lengths of needles, as the searches read them.
#pragma once

#include <cmath>
#include <concepts>

#include "src/physics/gas.h"

namespace needlework {

/// What tells a search half the length of each needle's axis and, if needles have a width, half
/// their diameter [L]: in the event loop the model, for which lengths are constants where all
/// needles have length 1.
template <class L>
concept Lengths = requires(const L& lengths, Needle i) {
  { L::has_width } -> std::convertible_to<bool>;
  { lengths.half_length(i) } -> std::same_as<double>;
  { lengths.radius(i) } -> std::same_as<double>;
};

/// Centres of two needles are not farther apart in contact. [L]
template <Lengths L>
double reach_of(const L& lengths, Needle i, Needle j) {
  const double axes = lengths.half_length(i) + lengths.half_length(j);
  if constexpr (L::has_width) return axes + (lengths.radius(i) + lengths.radius(j));
  return axes;
}

/// Lengths from the table of species, which is right for any gas.
struct SpeciesLengths {
  static constexpr bool has_width = true;
  const Gas& gas;
  double half_length(Needle i) const { return gas.bodies[gas.records[i].species].half_length; }
  double radius(Needle i) const { return gas.bodies[gas.records[i].species].radius; }
};

static_assert(Lengths<SpeciesLengths>);

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
