// When two spheres in uniform motion overlap: bodies within them can touch only then.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/vec3.h"

namespace needlework::kernels {

struct TimeSpan {
  double begin, end;
};

/// The times at which |r + v s| <= reach, with a margin; empty when begin > end.
// Of internal linkage, so that it is no inline function: GCC would inline it into every search.
static TimeSpan sphere_overlap(const Vec3d& r, const Vec3d& v, double reach) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double r2 = dot(r, r);
  // The second term covers the rounding of r x v and of r . r, for needles far apart.
  const double radius2 = reach * reach * (1 + 0x1p-20) + 0x1p-48 * r2;
  const double c = r2 - radius2;
  const double b = dot(r, v);
  const double a = dot(v, v);
  const Vec3d n = cross(r, v);
  const double d = a * radius2 - dot(n, n);
  if (c > 0 && (b >= 0 || !(d > 0))) return {infinity, -infinity};
  if (!(d > 0)) return {-infinity, infinity};
  const double root = std::sqrt(d);
  // The two roots of a s^2 + 2 b s + c without cancellation.
  const double q = b > 0 ? -(b + root) : root - b;
  if (q == 0) return {-infinity, infinity};
  const double s1 = c / q, s2 = a > 0 ? q / a : std::copysign(infinity, q);
  return {std::min(s1, s2), std::max(s1, s2)};
}

}  // namespace needlework::kernels
