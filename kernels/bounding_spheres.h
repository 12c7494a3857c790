// The first filter of a candidate pair: needles whose centres stay farther apart than the sum of
// their half lengths cannot meet.
#pragma once

#include "kernels/vec3.h"

namespace needlework::kernels {

/// True when |r + v s| > reach for all s in [0, until]. The square of the reach carries a margin of
/// 2^-20 of itself that covers the rounding of r and v. No square root, no division.
inline bool spheres_stay_apart(const Vec3d& r, const Vec3d& v, double reach, double until) {
  const double c = dot(r, r) - reach * reach * (1 + 0x1p-20);
  if (c <= 0) return false;
  const double b = dot(r, v);
  if (b >= 0) return true;
  const double a = dot(v, v);
  // The nearest approach is at -b / a, or at `until` when that comes first.
  if (-b < a * until) return c * a > b * b * (1 + 0x1p-40);
  return c + (2 * b + a * until) * until > 0;
}

}  // namespace needlework::kernels
