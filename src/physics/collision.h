// The collision rule: normal and tangential restitution of two needles at a point of contact.
#pragma once

#include "kernels/first_contact.h"
#include "src/physics/species.h"

namespace needlework {

/// Parameters of the rule.
struct Restitution {
  double epsilon = 1;  ///< normal, [0, 1]
  double beta = -1;    ///< tangential, [-1, 1]; -1 is smooth
};

/// The outcome of one collision.
struct Impact {
  Vec3d impulse;               ///< on the first needle; the second gets its negative [m L / time]
  double normal_velocity = 0;  ///< V_n before, along (u1 x u2) / |u1 x u2|
  double energy_change = 0;    ///< of the pair, <= 0
  Vec3d v_first, w_first, v_second, w_second;  ///< after
};

/// Two needles at their contact.
struct Meeting {
  const kernels::Flight& first;
  const kernels::Flight& second;
  Body body_first, body_second;
  const kernels::ContactGeometry& contact;
  int side;  ///< sign of r12 . (u1 x u2) before the contact
};

/// Collides two needles. They approach, V_n side < 0; what rounding says otherwise counts as
/// V_n = 0. `smooth` promises beta = -1 and leaves the tangential part out at compile time.
/// Source: Huthmann, Aspelmeier, Zippelius, Phys. Rev. E 60, 654 (1999), whose rule holds for
/// unlike needles with 2 / m replaced by 1 / m1 + 1 / m2 and an inertia for each.
template <bool smooth>
Impact collide(const Meeting& meeting, const Restitution& restitution);

}  // namespace needlework
