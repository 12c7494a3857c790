// Interval arithmetic: a number is known to lie within `radius` of `middle`.
//
// Every operation rounds its middle and adds a bound on the rounding error to the radius, so that
// the result contains the exact results for all numbers in the operands. Overflow and underflow
// are not handled, because no number here is near them.
#pragma once

#include <cmath>

#include "src/audit/quad.h"

namespace needlework::audit {

/// Bound on the relative error of one operation. It is doubled for Quad, whose software may be off
/// by more than half a unit.
template <class Real>
inline constexpr double unit_roundoff = 0x1p-112;
template <>
inline constexpr double unit_roundoff<double> = 0x1p-53;

template <class Real>
struct Ball {
  Real middle;
  double radius = 0;

  Ball() : middle(0) {}
  Ball(double exact) : middle(exact) {}  // implicit, so that numbers and balls can be mixed
  Ball(const Real& value, double off) : middle(value), radius(off) {}
};

/// Bounds on |a|, and a itself, as doubles.
template <class Real>
double magnitude(const Real& a) {
  using std::abs;
  return static_cast<double>(abs(a));
}
/// Covers the rounding errors of radii, which are sums of a few doubles, and of conversions.
inline constexpr double upward = 1 + 0x1p-49;
inline constexpr double downward = 1 - 0x1p-49;

template <class Real>
double upper(const Ball<Real>& a) {
  return (magnitude(a.middle) + a.radius) * upward;
}
template <class Real>
double lower(const Ball<Real>& a) {
  return std::max(0.0, magnitude(a.middle) * downward - a.radius * upward);
}

template <class Real>
Ball<Real> rounded(const Real& middle, double radius) {
  return {middle, (radius + unit_roundoff<Real> * magnitude(middle)) * upward};
}

template <class Real>
Ball<Real> operator-(const Ball<Real>& a) {
  return {Real(-a.middle), a.radius};
}

template <class Real>
Ball<Real> operator+(const Ball<Real>& a, const Ball<Real>& b) {
  return rounded(Real(a.middle + b.middle), a.radius + b.radius);
}

template <class Real>
Ball<Real> operator-(const Ball<Real>& a, const Ball<Real>& b) {
  return rounded(Real(a.middle - b.middle), a.radius + b.radius);
}

template <class Real>
Ball<Real> operator*(const Ball<Real>& a, const Ball<Real>& b) {
  return rounded(Real(a.middle * b.middle),
                 magnitude(a.middle) * b.radius + (magnitude(b.middle) + b.radius) * a.radius);
}

/// b must not contain 0.
template <class Real>
Ball<Real> operator/(const Ball<Real>& a, const Ball<Real>& b) {
  const Real quotient = a.middle / b.middle;
  return rounded(quotient, (a.radius + magnitude(quotient) * b.radius) / lower(b));
}

/// a must be positive, or exactly 0.
template <class Real>
Ball<Real> sqrt(const Ball<Real>& a) {
  using std::sqrt;
  if (a.middle <= 0) return {Real(0), std::sqrt(a.radius)};
  const Real root = sqrt(a.middle);
  return rounded(root, a.radius / magnitude(root) + unit_roundoff<Real> * magnitude(root));
}

/// Sine and cosine of the libraries are assumed to be correct within 4 units, plus 4 for each
/// radian, which software without a long pi may lose.
template <class Real>
double trigonometric_error(const Ball<Real>& angle) {
  return angle.radius + unit_roundoff<Real> * (4 + 4 * magnitude(angle.middle));
}

template <class Real>
Ball<Real> sin(const Ball<Real>& angle) {
  using std::sin;
  return {Real(sin(angle.middle)), trigonometric_error(angle) * upward};
}

template <class Real>
Ball<Real> cos(const Ball<Real>& angle) {
  using std::cos;
  return {Real(cos(angle.middle)), trigonometric_error(angle) * upward};
}

}  // namespace needlework::audit
