// What flight and collisions need of a species.
#pragma once

#include "needlework/composition.h"

namespace needlework {

/// Half length, inverse mass and inverse moment of inertia.
struct Body {
  double half_length = 0.5;     ///< [L]
  double inverse_mass = 1;      ///< [1 / m]
  double inverse_inertia = 12;  ///< 2 k / (m L^2) [1 / (m L^2)]

  double length() const { return 2 * half_length; }
};

/// For length 1 and mass 1 the inverse inertia is exactly 2 k.
inline Body body_of(const Species& species) {
  return {0.5 * species.length, 1 / species.mass,
          2 * species.k / (species.mass * (species.length * species.length))};
}

/// Whether the model needs no table for this species, because all its factors are 1.
inline bool is_unit(const Species& species) { return species.length == 1 && species.mass == 1; }

}  // namespace needlework
