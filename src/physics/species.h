// Properties that all needles of one species share.
#pragma once

#include <cstdint>
#include <vector>

namespace needlework {

/// Half length, inverse mass and inverse moment of inertia, as used for flight and collisions.
struct Body {
  double half_length = 0.5;     ///< [L]
  double inverse_mass = 1;      ///< [1 / m]
  double inverse_inertia = 12;  ///< 2 k / (m L^2) [1 / (m L^2)]

  double length() const { return 2 * half_length; }
};

/// One species, in the units of the scene, in which the default species has length 1 and mass 1.
struct Species {
  double length = 1;  ///< [L]
  double mass = 1;    ///< [m]
  double k = 6;       ///< m L^2 / (2 I) [1]

  /// The model needs no table for length 1 and mass 1, because all factors of the species are 1.
  bool is_unit() const { return length == 1 && mass == 1; }
  double inertia() const { return mass * (length * length) / (2 * k); }
  /// For length 1 and mass 1 the inverse inertia is exactly 2 k.
  Body body() const { return {0.5 * length, 1 / mass, 2 * k / (mass * (length * length))}; }
};

/// Index of a needle's species in Gas::species.
using SpeciesIndex = std::uint8_t;

}  // namespace needlework
