// Free flight of a pair in the oracle's arithmetic, and f = r12 . (u1 x u2) as a function of time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "needlework/predict.h"
#include "tests/support/real.h"
#include "tests/support/vector.h"

namespace needlework::test {

/// Both needles with lengths measured in units of their mean length, so that |r12| <= 1 at a
/// contact, and time in units of 2^-exponent, so that the larger of |v12| and |w1| + |w2| lies in
/// [1/2, 1), unless both are 0.
template <class Real>
struct Motion {
  Vec<Real> separation, velocity;           ///< r1 - r2 and v1 - v2
  std::array<Vec<Real>, 2> director, side;  ///< u(t) = director cos + side sin
  std::array<Real, 2> spin;                 ///< |w|
  std::array<Real, 2> half;                 ///< half lengths; their sum is 1
  int exponent = 0;

  Real total_spin() const { return spin[0] + spin[1]; }
};

/// The mean length of both needles.
template <class Real>
Real unit_of_length(const FreeNeedle& first, const FreeNeedle& second) {
  return (Real(first.length) + Real(second.length)) / 2;
}

template <class Real>
Motion<Real> make_motion(const FreeNeedle& first, const FreeNeedle& second) {
  using std::frexp;
  using std::ldexp;
  using std::max;
  Motion<Real> motion;
  motion.separation = convert<Real>(first.position) - convert<Real>(second.position);
  motion.velocity = convert<Real>(first.velocity) - convert<Real>(second.velocity);
  const Real unit = unit_of_length<Real>(first, second);
  for (Real& r : motion.separation) r /= unit;
  for (Real& v : motion.velocity) v /= unit;
  motion.half = {Real(first.length) / (2 * unit), Real(second.length) / (2 * unit)};
  const std::array<const FreeNeedle*, 2> needles = {&first, &second};
  for (int i = 0; i < 2; ++i) {
    const Vec<Real> given = convert<Real>(needles[i]->orientation);
    const Vec<Real> u = Real(1 / norm(given)) * given;
    const Vec<Real> spin = convert<Real>(needles[i]->angular_velocity);
    const Vec<Real> projected = spin - Real(dot(spin, given) / dot(given, given)) * given;
    motion.director[i] = u;
    motion.spin[i] = norm(projected);
    motion.side[i] = {Real(0), Real(0), Real(0)};
    if (motion.spin[i] > 0) motion.side[i] = Real(1 / motion.spin[i]) * cross(projected, u);
  }
  const Real fastest = max<Real>(norm(motion.velocity), motion.total_spin());
  if (fastest > 0) frexp(fastest, &motion.exponent);
  for (Real& v : motion.velocity) v = ldexp(v, -motion.exponent);
  for (Real& w : motion.spin) w = ldexp(w, -motion.exponent);
  return motion;
}

template <class To, class From>
Motion<To> convert_motion(const Motion<From>& from) {
  Motion<To> to;
  to.separation = convert<To>(from.separation);
  to.velocity = convert<To>(from.velocity);
  for (int i = 0; i < 2; ++i) {
    to.director[i] = convert<To>(from.director[i]);
    to.side[i] = convert<To>(from.side[i]);
    to.spin[i] = static_cast<To>(from.spin[i]);
    to.half[i] = static_cast<To>(from.half[i]);
  }
  to.exponent = from.exponent;
  return to;
}

/// f and its derivatives. u1 x u2 is a sum of the four products of cos and sin of |w1| t and
/// |w2| t, each with a constant vector, so the k-th derivative is sum_j (c[k][j] + d[k][j] t)
/// tau_j. As the squares of the tau_j add up to 1, |f^(k)| <= |c[k] + d[k] t|, which is convex in
/// t.
template <class T>
struct Curve {
  std::array<T, 2> spin;
  std::array<std::array<T, 4>, 4> c, d;
  T offset = 0;                       ///< subtracted from f, not from the derivatives
  std::array<T, 3> noise_c, noise_d;  ///< rounding error of f^(k): (c + d |t|) (1 + W |t|)

  struct Value {
    T f, f1, f2;
  };

  Value operator()(const T& t) const {
    using std::cos;
    using std::sin;
    const T c1 = cos(spin[0] * t), s1 = sin(spin[0] * t);
    const T c2 = cos(spin[1] * t), s2 = sin(spin[1] * t);
    const std::array<T, 4> tau = {c1 * c2, c1 * s2, s1 * c2, s1 * s2};
    std::array<T, 3> sum = {T(0), T(0), T(0)};
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 4; ++j) sum[k] += (c[k][j] + d[k][j] * t) * tau[j];
    }
    return {sum[0] - offset, sum[1], sum[2]};
  }

  T noise(int k, const T& t) const {
    using std::abs;
    const T age = abs(t);
    return (noise_c[k] + noise_d[k] * age) * (1 + (spin[0] + spin[1]) * age);
  }

  /// Bound on |f^(k)| at t.
  T bound(int k, const T& t) const {
    using std::sqrt;
    T sum = 0;
    for (int j = 0; j < 4; ++j) {
      const T value = c[k][j] + d[k][j] * t;
      sum += value * value;
    }
    return sqrt(sum);
  }
};

template <class Real>
Curve<Real> make_curve(const Motion<Real>& motion) {
  Curve<Real> curve;
  const Real& w1 = curve.spin[0] = motion.spin[0];
  const Real& w2 = curve.spin[1] = motion.spin[1];
  const std::array<Vec<Real>, 2> first = {motion.director[0], motion.side[0]};
  const std::array<Vec<Real>, 2> second = {motion.director[1], motion.side[1]};
  for (int j = 0; j < 4; ++j) {
    const Vec<Real> product = cross(first[j / 2], second[j % 2]);
    curve.c[0][j] = dot(motion.separation, product);
    curve.d[0][j] = dot(motion.velocity, product);
  }
  // One derivative: d/dt of (cc, cs, sc, ss), applied to coefficients.
  const auto turned = [&](const std::array<Real, 4>& a) -> std::array<Real, 4> {
    return {w2 * a[1] + w1 * a[2], w1 * a[3] - w2 * a[0], w2 * a[3] - w1 * a[0],
            -w1 * a[1] - w2 * a[2]};
  };
  for (int k = 1; k < 4; ++k) {
    curve.c[k] = turned(curve.c[k - 1]);
    for (int j = 0; j < 4; ++j) curve.c[k][j] += curve.d[k - 1][j];
    curve.d[k] = turned(curve.d[k - 1]);
  }
  // The error of the coefficients is some units of the vectors from which they are computed.
  const Real unit = 64 * unit_roundoff<Real>();
  const Real distance = norm(motion.separation), speed = norm(motion.velocity);
  Real power = 1, lower = 0;  // W^k and k W^(k-1)
  for (int k = 0; k < 3; ++k) {
    curve.noise_c[k] = unit * (distance * power + speed * lower);
    curve.noise_d[k] = unit * speed * power;
    lower = lower * motion.total_spin() + power;
    power *= motion.total_spin();
  }
  return curve;
}

/// The same function in double, its coefficients rounded once.
template <class Real>
Curve<double> round_curve(const Curve<Real>& from) {
  Curve<double> to;
  for (int i = 0; i < 2; ++i) to.spin[i] = static_cast<double>(from.spin[i]);
  to.offset = static_cast<double>(from.offset);
  const double unit = 16 * unit_roundoff<double>();
  for (int k = 0; k < 4; ++k) {
    double sum_c = k == 0 ? std::abs(to.offset) : 0, sum_d = 0;
    for (int j = 0; j < 4; ++j) {
      to.c[k][j] = static_cast<double>(from.c[k][j]);
      to.d[k][j] = static_cast<double>(from.d[k][j]);
      sum_c += std::abs(to.c[k][j]);
      sum_d += std::abs(to.d[k][j]);
    }
    if (k < 3) {
      to.noise_c[k] = unit * sum_c + static_cast<double>(from.noise_c[k]);
      to.noise_d[k] = unit * sum_d + static_cast<double>(from.noise_d[k]);
    }
  }
  return to;
}

/// The pair at one time.
template <class T>
struct Geometry {
  Vec<T> separation;  ///< r12
  std::array<Vec<T>, 2> u, du;
  Vec<T> x, dx;                ///< u1 x u2
  T xx;                        ///< x . x
  std::array<T, 2> numerator;  ///< of s12 and s21, over xx
  std::array<T, 2> arm_rate;   ///< d s12 / dt, d s21 / dt
};

template <class T>
Geometry<T> at(const Motion<T>& motion, const T& t) {
  using std::cos;
  using std::sin;
  Geometry<T> g;
  g.separation = motion.separation + t * motion.velocity;
  for (int i = 0; i < 2; ++i) {
    const T cosine = cos(motion.spin[i] * t), sine = sin(motion.spin[i] * t);
    g.u[i] = cosine * motion.director[i] + sine * motion.side[i];
    g.du[i] =
        T(motion.spin[i] * cosine) * motion.side[i] - T(motion.spin[i] * sine) * motion.director[i];
  }
  g.x = cross(g.u[0], g.u[1]);
  g.dx = cross(g.du[0], g.u[1]) + cross(g.u[0], g.du[1]);
  g.xx = dot(g.x, g.x);
  const T growth = 2 * dot(g.x, g.dx);
  for (int i = 0; i < 2; ++i) {
    const Vec<T>& other = g.u[1 - i];
    const Vec<T> moment = cross(other, g.separation);
    const Vec<T> change = cross(g.du[1 - i], g.separation) + cross(other, motion.velocity);
    g.numerator[i] = dot(moment, g.x);
    const T rate = dot(change, g.x) + dot(moment, g.dx);
    g.arm_rate[i] = (rate - g.numerator[i] / g.xx * growth) / g.xx;
  }
  return g;
}

}  // namespace needlework::test
