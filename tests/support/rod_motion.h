// The relative motion of two rods of finite width and the points of their axes that are nearest, by
// comparing all candidates, in numbers of any type.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kernels/rod_contact.h"
#include "tests/support/vector.h"

namespace needlework::test {

/// Two rods, by value.
struct RodCase {
  kernels::Flight first, second;
  kernels::RodPair pair;  ///< but for the pointers
  double horizon = 0;

  /// A view of this case, which must outlive it.
  kernels::RodPair view() const {
    kernels::RodPair out = pair;
    out.first = &first;
    out.second = &second;
    return out;
  }
  RodCase exchanged() const;
};

template <class Real>
class RodMotion {
 public:
  explicit RodMotion(const RodCase& rods);

  /// A point on each axis that have the least distance.
  struct Nearest {
    Real square = 0;       ///< of the distance
    Real arm[2] = {0, 0};  ///< of the points
    Vec<Real> director[2];
    Vec<Real> gap;  ///< from the second point to the first
  };
  Nearest nearest(const Real& s) const;
  Real distance(const Real& s) const {
    using std::sqrt;
    return sqrt(nearest(s).square);
  }
  Vec<Real> director(int i, const Real& s) const {
    using std::cos;
    using std::sin;
    const Real phase = omega[i] * (s + delay[i]);
    return Real(cos(phase)) * u[i] + Real(sin(phase)) * p[i];
  }

  Vec<Real> r, v;        ///< r12 at s = 0, and its rate of change
  Vec<Real> u[2], p[2];  ///< of the records: directors, and their rates of change over omega
  Real omega[2], delay[2], half[2];
  Real reach;   ///< sum of the sizes of what has been added to get r
  Real speed;   ///< of a point of one axis relative to one of the other, not below
  Real growth;  ///< half lengths are 1 + growth s times as large at s

 private:
  static Vec<Real> real(const Vec3d& a) { return {Real(a.x), Real(a.y), Real(a.z)}; }
  static Real real(const DoubleDouble& a) { return Real(a.hi) + Real(a.lo); }
  static Vec<Real> real(const Vec3dd& a) { return {real(a.x), real(a.y), real(a.z)}; }
};

template <class Real>
RodMotion<Real>::RodMotion(const RodCase& rods) {
  const kernels::Flight* flights[2] = {&rods.first, &rods.second};
  delay[0] = real(rods.pair.elapsed_first);
  delay[1] = real(rods.pair.elapsed_second);
  half[0] = rods.pair.half_first;
  half[1] = rods.pair.half_second;
  const Vec<Real> shift = real(rods.pair.shift);
  reach = norm(shift);
  Vec<Real> centre[2];
  for (int i = 0; i < 2; ++i) {
    const kernels::Flight& flight = *flights[i];
    const Vec<Real> flown = delay[i] * real(flight.v);
    centre[i] = real(flight.r) + flown;
    reach += norm(real(flight.r)) + norm(flown);
    const Vec<Real> w = real(flight.w);
    omega[i] = norm(w);
    u[i] = real(flight.u);
    p[i] = {Real(0), Real(0), Real(0)};
    if (omega[i] > 0) p[i] = Real(1 / omega[i]) * cross(w, u[i]);
  }
  r = (centre[0] - centre[1]) - shift;
  v = real(rods.first.v) - real(rods.second.v);
  if (rods.pair.fall) {
    r = r + real(rods.pair.fall->place);
    v = v + real(rods.pair.fall->velocity);
    reach += norm(real(rods.pair.fall->place));
  }
  growth = rods.pair.growth;
  const Real largest = 1 + growth * Real(rods.horizon);
  speed = (norm(v) + largest * (half[0] * omega[0] + half[1] * omega[1]) +
           growth * (half[0] + half[1])) *
          (1 + Real(1e-9));
}

template <class Real>
typename RodMotion<Real>::Nearest RodMotion<Real>::nearest(const Real& s) const {
  using std::abs;
  using std::max;
  using std::min;
  Nearest out;
  bool is_first = true;
  const Real grown = 1 + growth * s, half[2] = {this->half[0] * grown, this->half[1] * grown};
  for (int i = 0; i < 2; ++i) out.director[i] = director(i, s);
  const Vec<Real>*d = out.director, between = r + s * v;
  // The gap itself, as its square is least at the nearest points: what they are off matters little.
  const auto consider = [&](const Real& first, const Real& second) {
    const Vec<Real> gap = (between + first * d[0]) - second * d[1];
    const Real square = dot(gap, gap);
    if (!is_first && !(square < out.square)) return;
    is_first = false;
    out.square = square;
    out.arm[0] = first;
    out.arm[1] = second;
    out.gap = gap;
  };
  // Each tip with the other axis; `from` leads from the centre of that one to the tip.
  for (int i = 0; i < 2; ++i) {
    const Real sign = i == 0 ? 1 : -1;
    for (const int end : {-1, 1}) {
      const Real tip = end * half[i];
      const Vec<Real> from = sign * between + tip * d[i];
      const Real along = max(Real(-half[1 - i]), min(half[1 - i], dot(from, d[1 - i])));
      i == 0 ? consider(tip, along) : consider(along, tip);
    }
  }
  // Both inside.
  const Vec<Real> x = cross(d[0] - d[1], Real(0.5) * (d[0] + d[1]));
  const Real xx = dot(x, x);
  if (xx > 0) {
    const Real s12 = dot(cross(d[1], between), x) / xx, s21 = dot(cross(d[0], between), x) / xx;
    if (abs(s12) < half[0] && abs(s21) < half[1]) consider(s12, s21);
  }
  return out;
}

}  // namespace needlework::test
