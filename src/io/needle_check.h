// What must hold for the director and the angular velocity of a needle that is read from a file.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace needlework::io {

/// How far a director's length may be from 1, and the part of an angular velocity along the
/// director from 0, in a state that is taken as it is [1].
inline constexpr double director_tolerance = 1e-6;
/// The same in a text, whose numbers may be rounded: what is further off than director_tolerance is
/// projected [1].
inline constexpr double largest_rounding = 1e-3;

inline double length_of(const std::array<double, 3>& a) { return std::hypot(a[0], a[1], a[2]); }

inline bool is_unit(const std::array<double, 3>& u) {
  return std::abs(length_of(u) - 1) <= director_tolerance;
}

/// The component of w along the unit vector u, divided by the length of w; 0 if w is 0.
inline double part_along(const std::array<double, 3>& w, const std::array<double, 3>& u) {
  // The division prevents overflow and underflow in the length of the vector.
  const double scale = std::max({std::abs(w[0]), std::abs(w[1]), std::abs(w[2])});
  if (scale == 0) return 0;
  const std::array direction{w[0] / scale, w[1] / scale, w[2] / scale};
  return (direction[0] * u[0] + direction[1] * u[1] + direction[2] * u[2]) / length_of(direction);
}

inline std::array<double, 3> normalised(const std::array<double, 3>& u) {
  const double length = length_of(u);
  return {u[0] / length, u[1] / length, u[2] / length};
}

/// The part of w normal to the unit vector u. Computed twice, because the first pass leaves a
/// rounding of w that counts where its normal part is small.
inline std::array<double, 3> without_part_along(std::array<double, 3> w,
                                                const std::array<double, 3>& u) {
  for (int pass = 0; pass < 2; ++pass) {
    const double along = part_along(w, u) * length_of(w);
    for (std::size_t axis = 0; axis < 3; ++axis) w[axis] -= along * u[axis];
  }
  return w;
}

}  // namespace needlework::io
