// Directors are unit vectors, and angular velocities are normal to them. Rounding violates both,
// so they are restored in each new record.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/power_of_two.h"
#include "kernels/vec3.h"

namespace needlework {

/// a / |a|, without overflow or underflow; a must not be 0.
inline Vec3d normalised(const Vec3d& a) {
  const double size = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  const int exponent = -exponent_of(size);
  const Vec3d b{times_power_of_two(a.x, exponent), times_power_of_two(a.y, exponent),
                times_power_of_two(a.z, exponent)};
  const double length = std::sqrt(dot(b, b));
  return {b.x / length, b.y / length, b.z / length};
}

/// The part of `a` normal to the unit vector `u`.
inline Vec3d project_out(const Vec3d& a, const Vec3d& u) { return a - u * dot(a, u); }

}  // namespace needlework
