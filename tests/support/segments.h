// Closest approach of two segments, the slow and sure way.
#pragma once

#include <algorithm>

#include "kernels/vec3.h"
#include "tests/support/real.h"

namespace needlework::test {

struct NearestPoints {
  Vec3d gap;  ///< from the point on the second segment to that on the first
};

/// In many digits: a tip of one and the nearest point of the other, or two points within both.
/// Centres, directors and half lengths.
inline NearestPoints nearest_points(const Vec3d& r1, const Vec3d& u1, const Vec3d& r2,
                                    const Vec3d& u2, double half1 = 0.5, double half2 = 0.5) {
  using V = Vec3<Quad>;
  const auto wide = [](const Vec3d& a) { return V{Quad(a.x), Quad(a.y), Quad(a.z)}; };
  const V r = wide(r1) - wide(r2), a = wide(u1), b = wide(u2);
  const Quad h1(half1), h2(half2), aa = dot(a, a), bb = dot(b, b), ab = dot(a, b);
  const Quad ra = dot(r, a), rb = dot(r, b);
  const auto clamped = [](const Quad& x, const Quad& half) {
    return std::clamp<Quad>(x, -half, half);
  };
  V best{};
  Quad least(-1);
  const auto consider = [&](const Quad& s, const Quad& t) {
    const V gap = r + a * s - b * t;
    const Quad square = dot(gap, gap);
    if (least < 0 || square < least) {
      least = square;
      best = gap;
    }
  };
  for (const Quad& tip : {Quad(-h1), h1}) consider(tip, clamped((rb + tip * ab) / bb, h2));
  for (const Quad& tip : {Quad(-h2), h2}) consider(clamped((tip * ab - ra) / aa, h1), tip);
  const Quad determinant = aa * bb - ab * ab;
  if (determinant > 0) {
    const Quad s = (ab * rb - bb * ra) / determinant, t = (aa * rb - ab * ra) / determinant;
    if (abs(s) <= h1 && abs(t) <= h2) consider(s, t);
  }
  return {{static_cast<double>(best.x), static_cast<double>(best.y), static_cast<double>(best.z)}};
}

}  // namespace needlework::test
