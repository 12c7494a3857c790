// Double-double numbers: an unevaluated sum hi + lo of two doubles, about 106 bits. They decide
// what double cannot decide. No fused multiply-add is needed: products are split exactly, so every
// compiler and machine gives the same bits.
//
// Source: T. J. Dekker, Numer. Math. 18, 224 (1971); M. Joldes, J.-M. Muller, V. Popescu, ACM
// Trans. Math. Softw. 44, 15 (2017) for the error bounds, each operation below 2^-102 relative.
#pragma once

#include <cmath>

#include "kernels/ieee_arithmetic.h"
#include "kernels/vec3.h"

namespace needlework {

struct DoubleDouble {
  double hi = 0, lo = 0;
  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : hi(value) {}  // NOLINT: a double is a double-double
  constexpr DoubleDouble(double high, double low) : hi(high), lo(low) {}
  friend bool operator==(const DoubleDouble&, const DoubleDouble&) = default;
};

using Vec3dd = Vec3<DoubleDouble>;

/// a + b exactly.
inline DoubleDouble two_sum(double a, double b) {
  const double s = a + b;
  const double bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

/// a + b exactly when |a| >= |b| or a = 0.
inline DoubleDouble quick_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// a * b exactly; |a|, |b| < 2^990, |a b| < 2^1023 and the product's low part not subnormal.
inline DoubleDouble two_prod(double a, double b) {
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const double p = a * b;
  const double ta = splitter * a, tb = splitter * b;
  const double a1 = ta - (ta - a), a2 = a - a1;
  const double b1 = tb - (tb - b), b2 = b - b1;
  return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble s = two_sum(a.hi, b.hi);
  const DoubleDouble t = two_sum(a.lo, b.lo);
  const DoubleDouble v = quick_two_sum(s.hi, s.lo + t.hi);
  return quick_two_sum(v.hi, v.lo + t.lo);
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_prod(a.hi, b.hi);
  return quick_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double q1 = a.hi / b.hi;
  const DoubleDouble r1 = a - b * DoubleDouble(q1);
  const double q2 = r1.hi / b.hi;
  const DoubleDouble r2 = r1 - b * DoubleDouble(q2);
  const double q3 = r2.hi / b.hi;
  return quick_two_sum(q1, q2) + DoubleDouble(q3);
}

/// Square root of a >= 0.
inline DoubleDouble sqrt(const DoubleDouble& a) {
  if (!(a.hi > 0)) return {};
  const double x = std::sqrt(a.hi);
  const DoubleDouble rest = a - two_prod(x, x);
  return quick_two_sum(x, rest.hi / (2 * x));
}

inline double to_double(const DoubleDouble& a) { return a.hi + a.lo; }
inline double to_double(double a) { return a; }

inline Vec3dd to_double_double(const Vec3d& a) { return {a.x, a.y, a.z}; }
inline Vec3d to_double(const Vec3d& a) { return a; }
inline Vec3d to_double(const Vec3dd& a) { return {to_double(a.x), to_double(a.y), to_double(a.z)}; }

}  // namespace needlework
