// Measures of rods of finite width as convex bodies, by which theories of fluids know them.
#pragma once

#include <numbers>

#include "needlework/composition.h"

namespace needlework {

/// Of one body, the mean of those of a species or, added up, of all in a unit of volume.
struct ConvexBody {
  double radius = 0;   ///< of curvature, the mean of both over the surface [L]
  double surface = 0;  ///< [L^2]
  double volume = 0;   ///< [L^3]
};

inline ConvexBody convex_body(const Species& species) {
  const double length = species.length, width = species.diameter;
  return {length / 4 + width / 2, std::numbers::pi * (species.product() + species.square()),
          species.volume()};
}

/// Adds so many of these bodies per volume. [L^-3]
inline void add(ConvexBody& fluid, const ConvexBody& each, double density) {
  fluid.radius += density * each.radius;
  fluid.surface += density * each.surface;
  fluid.volume += density * each.volume;
}

/// The same of bodies that have numbers of their own, the mean over each two of them. [L^3]
inline double mean_excluded_volume(const Species& a, const Species& b) {
  constexpr double pi = std::numbers::pi;
  const auto thick = [](const Species& s) {  // the mean of D^2 L
    return 4 / pi * s.volume() - 2.0 / 3 * s.cube();
  };
  const auto sides = [&](const Species& s, const Species& other) {
    return thick(s) + 2 * s.product() * other.diameter + s.length * other.square();
  };
  return 0.25 * pi * (a.product() * b.length + a.length * b.product()) +
         0.25 * pi * (sides(a, b) + sides(b, a)) +
         pi / 6 * (a.cube() + 3 * (a.square() * b.diameter + a.diameter * b.square()) + b.cube());
}

/// Volume from which the centre of a rod is excluded by another one, averaged over their
/// directions; 0 for needles. [L^3]
inline double excluded_volume(const Species& a, const Species& b) {
  if (a.sizes || b.sizes) return mean_excluded_volume(a, b);
  constexpr double pi = std::numbers::pi;
  const double width = 0.5 * (a.diameter + b.diameter);
  return 0.5 * pi * width * a.length * b.length +
         pi * width * width * (a.length + b.length + 4.0 / 3 * width);
}

}  // namespace needlework
