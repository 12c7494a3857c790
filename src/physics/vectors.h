// Vectors of three numbers of callers and files, and those of the kernels.
#pragma once

#include <array>
#include <cmath>

#include "kernels/vec3.h"

namespace needlework {

inline Vec3d vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

inline std::array<double, 3> to_array(const Vec3d& a) { return {a.x, a.y, a.z}; }

inline bool is_finite(const Vec3d& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

}  // namespace needlework
