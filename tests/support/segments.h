// Closest approach of two segments of length 1, the slow and sure way.
#pragma once

#include <algorithm>

#include "kernels/vec3.h"
#include "tests/support/real.h"

namespace needlework::test {

struct NearestPoints {
  Vec3d gap;  ///< from the point on the second segment to that on the first
};

/// In many digits: a tip of one and the nearest point of the other, or two points within both.
inline NearestPoints nearest_points(const Vec3d& r1, const Vec3d& u1, const Vec3d& r2,
                                    const Vec3d& u2) {
  using V = Vec3<Quad>;
  const auto wide = [](const Vec3d& a) { return V{Quad(a.x), Quad(a.y), Quad(a.z)}; };
  const V r = wide(r1) - wide(r2), a = wide(u1), b = wide(u2);
  const Quad half(0.5), aa = dot(a, a), bb = dot(b, b), ab = dot(a, b);
  const Quad ra = dot(r, a), rb = dot(r, b);
  const auto clamped = [&](const Quad& x) { return std::clamp<Quad>(x, -half, half); };
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
  for (const Quad& tip : {Quad(-half), half}) {
    consider(tip, clamped((rb + tip * ab) / bb));
    consider(clamped((tip * ab - ra) / aa), tip);
  }
  const Quad determinant = aa * bb - ab * ab;
  if (determinant > 0) {
    const Quad s = (ab * rb - bb * ra) / determinant, t = (aa * rb - ab * ra) / determinant;
    if (abs(s) <= half && abs(t) <= half) consider(s, t);
  }
  return {{static_cast<double>(best.x), static_cast<double>(best.y), static_cast<double>(best.z)}};
}

}  // namespace needlework::test
