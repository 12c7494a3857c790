// How other programs are told to draw a needle: as a thin ellipsoid along the z axis, turned by a
// quaternion. OVITO and HOOMD-blue draw that; they do not know directors.
#pragma once

#include <array>
#include <cmath>

#include "src/io/needle_check.h"

namespace needlework::io {

/// Needles have no thickness. They are drawn with this radius in the middle, in lengths [1].
inline constexpr double drawn_radius = 0.02;

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
