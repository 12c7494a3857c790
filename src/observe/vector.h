// Vectors in space, as the arrays of a state hold them.
#pragma once

#include <array>

#include "src/box/vector.h"

namespace needlework::observe {

inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// P2(x) = (3 x^2 - 1) / 2, the second Legendre polynomial.
inline double second_legendre(double x) { return 1.5 * x * x - 0.5; }

}  // namespace needlework::observe
