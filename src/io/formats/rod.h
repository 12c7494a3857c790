// How other programs are told to draw a needle: as a thin ellipsoid along the z axis, turned by a
// quaternion. OVITO and HOOMD-blue draw that; they do not know directors. Rods of finite width are
// spherocylinders of OVITO.
#pragma once

#include <array>
#include <cmath>

#include "src/io/needle_check.h"

namespace needlework::io {

/// Needles have no thickness. They are drawn with this radius in the middle, in lengths [1].
inline constexpr double drawn_radius = 0.02;

/// What OVITO calls the aspherical shape: of needles the semi-axes of an ellipsoid; of rods of
/// finite width radius, radius and length of the axis, by which it draws spherocylinders, also
/// spheres among them; in a gas of spheres alone their radii, which are semi-axes as well. [L]
inline std::array<double, 3> drawn_shape(double length, double diameter, bool all_are_spheres) {
  const double radius = 0.5 * diameter;
  if (all_are_spheres) return {radius, radius, radius};
  if (radius > 0) return {radius, radius, length};
  return {drawn_radius * length, drawn_radius * length, 0.5 * length};
}

/// A unit quaternion (w, x, y, z) that turns (0, 0, 1) into the direction of a.
inline std::array<double, 4> quaternion_of(const std::array<double, 3>& a) {
  const std::array<double, 3> u = normalised(a);
  // Of two forms, the one that is not near 0.
  std::array<double, 4> q{1 + u[2], -u[1], u[0], 0};
  if (u[2] < 0) q = {u[0], 0, 1 - u[2], u[1]};
  const double size = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  for (double& component : q) component /= size;
  return q;
}

}  // namespace needlework::io
