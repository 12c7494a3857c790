// What flight and collisions need of a species.
#pragma once

#include "needlework/composition.h"

namespace needlework {

/// Half length, inverse mass and inverse moment of inertia.
struct Body {
  double half_length = 0.5;     ///< of the axis [L]
  double inverse_mass = 1;      ///< [1 / m]
  double inverse_inertia = 12;  ///< 2 k / (m L^2), 0 for spheres [1 / (m L^2)]
  double radius = 0;            ///< half the diameter, 0 for needles [L]

  double reach() const { return half_length + radius; }  ///< from the centre [L]
};

/// For length 1 and mass 1 the inverse inertia is exactly 2 k.
inline Body body_of(const Species& species) {
  const double squares = species.mass * (species.length * species.length);
  return {0.5 * species.length, 1 / species.mass, species.turns() ? 2 * species.k / squares : 0,
          0.5 * species.diameter};
}

/// Whether the model needs no table for this species, because all its factors are 1.
inline bool is_unit(const Species& species) {
  return species.length == 1 && species.mass == 1 && species.diameter == 0;
}

}  // namespace needlework
