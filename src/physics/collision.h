// The collision rule: normal and tangential restitution of two needles at a point of contact.
#pragma once

#include "kernels/first_contact.h"
#include "src/physics/body.h"

namespace needlework {

/// The outcome of one collision.
struct Impact {
  Vec3d impulse;               ///< on the first needle; the second gets the opposite [m L / time]
  double normal_velocity = 0;  ///< V_n before the collision, along (u1 x u2) / |u1 x u2|
  double energy_change = 0;    ///< of both needles, <= 0 but for the work of growth
  double growth_work = 0;      ///< the part of it that growth has done
  Vec3d v_first, w_first, v_second, w_second;  ///< velocities after the collision
};

/// Two needles at their contact.
struct CollidingPair {
  const Vec3d& v_first;  ///< velocities at the contact
  const Vec3d& w_first;
  const Vec3d& v_second;
  const Vec3d& w_second;
  const Body& body_first;
  const Body& body_second;
  const kernels::ContactGeometry& contact;
  int side;           ///< sign of r12 . (u1 x u2) before the contact; 1 for rods
  double growth = 0;  ///< how fast growth brings surfaces of finite width together [L / time]
  double scale = 1;   ///< of the radii, where bodies grow
};

/// What needs a rule of its own.
enum class Surface {
  smooth,       ///< beta = -1
  rough,        ///< any beta
  wide,         ///< smooth rods of finite width, whose normal need not be normal to the directors
  sphere,       ///< smooth spheres, which nothing turns
  rough_sphere  ///< spheres and any beta
};

/// Velocities and impulse after a collision of two needles. They must approach, V_n side < 0; if
/// rounding gives another sign, V_n counts as 0. Source: Huthmann, Aspelmeier, Zippelius, Phys.
/// Rev. E 60, 654 (1999). For unlike needles 2 / m is replaced by 1 / m1 + 1 / m2, and each needle
/// has its own inertia; at the caps of rods the inertia counts by |u x n|^2 < 1. Surfaces that
/// growth brings together at G approach at V_n - G, of which epsilon reverses a part, so that
/// V_n becomes G + epsilon (G - V_n).
/// Rough spheres: Huthmann, Zippelius, Phys. Rev. E 56, R6275 (1997); V_n does not depend on their
/// spins.
template <Surface surface>
Impact collide(const CollidingPair& pair, const Restitution& restitution);

}  // namespace needlework
