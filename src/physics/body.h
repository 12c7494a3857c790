// What flight and collisions need to know of a body.
#pragma once

#include <limits>

#include "needlework/composition.h"
#include "src/composition/sizes.h"

namespace needlework {

/// A needle, rod or sphere. The factors of a needle of length 1 and mass 1 are exact.
struct Body {
  double half_length = 0.5;  ///< of the axis [L]
  double radius = 0;         ///< half the diameter, 0 for needles [L]
  /// How far any point of it may depart from the flight of its record, where needles slide. [L]
  double departure = 0;
  double mass = 1;
  double inertia = 1.0 / 12;    ///< 0 for smooth spheres, whose rotation nothing changes [m L^2]
  double inverse_mass = 1;      ///< [1 / m]
  double inverse_inertia = 12;  ///< 2 k / (m L^2), 0 for smooth spheres [1 / (m L^2)]

  bool has_axis() const { return half_length > 0; }  ///< whether it is no sphere
  bool turns() const { return inertia > 0; }         ///< whether collisions change its rotation
  double length() const { return 2 * half_length; }  ///< of the axis [L]
  double extent() const { return length() + 2 * radius; }  ///< from end to end [L]
  /// From the centre: centres of two bodies in contact are no farther apart than both reach. [L]
  double reach() const { return half_length + width(); }
  /// From the axis. [L]
  double width() const { return radius + departure; }
};

inline Body body_of(const Species& species) {
  const double squares = species.mass * (species.length * species.length);
  return {.half_length = 0.5 * species.length,
          .radius = 0.5 * species.diameter,
          .mass = species.mass,
          .inertia = species.inertia(),
          .inverse_mass = 1 / species.mass,
          .inverse_inertia = species.has_axis() ? 2 * species.k / squares
                             : species.turns()  ? 1 / species.inertia()
                                                : 0};
}

inline Body body_of(const BodyNumbers& numbers) {
  return {.half_length = 0.5 * numbers.length,
          .radius = 0.5 * numbers.diameter,
          .mass = numbers.mass,
          .inertia = numbers.inertia,
          .inverse_mass = 1 / numbers.mass,
          .inverse_inertia = numbers.inertia > 0 ? 1 / numbers.inertia : 0};
}

/// The same body, which nothing moves.
inline Body fixed(Body body) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  body.mass = infinity;
  if (body.turns()) body.inertia = infinity;
  body.inverse_mass = body.inverse_inertia = 0;
  return body;
}

/// Whether the model looks up nothing for this species, because all its factors are 1.
inline bool is_unit(const Species& species) {
  return species.length == 1 && species.mass == 1 && species.diameter == 0 && !species.sizes;
}

}  // namespace needlework
