// The contact function in many digits, from the records taken as exact numbers.
#pragma once

#include "kernels/contact_function.h"
#include "tests/support/real.h"
#include "tests/support/vector.h"

namespace needlework::test {

template <class Real>
Real real(double a) {
  return Real(a);
}
template <class Real>
Real real(const DoubleDouble& a) {
  return Real(a.hi) + Real(a.lo);
}
template <class Real, class T>
Vec<Real> real(const Vec3<T>& a) {
  return {real<Real>(a.x), real<Real>(a.y), real<Real>(a.z)};
}

/// f, its derivatives by s, and the geometry that they come from.
template <class Real>
struct PreciseContact {
  Real f, df, ddf;
  Vec<Real> u[2], r, x;
};

/// At scaled time s, s / scale.per_time after s = 0, in scaled lengths.
template <class Real>
PreciseContact<Real> precise_contact(const kernels::Pair& pair, const kernels::PairScale& scale,
                                     const Real& s) {
  const kernels::Flight* flight[2] = {pair.first, pair.second};
  const DoubleDouble elapsed[2] = {pair.elapsed_first, pair.elapsed_second};
  const Real unit = scale.per_rate;      // time per scaled time
  const Real length = scale.per_length;  // scaled length per length
  PreciseContact<Real> out;
  Vec<Real> centre[2], du[2], ddu[2];
  for (int i = 0; i < 2; ++i) {
    const Vec<Real> u = real<Real>(flight[i]->u), w = real<Real>(flight[i]->w);
    const Real omega = norm(w), time = real<Real>(elapsed[i]) + s * unit, angle = omega * time;
    const Vec<Real> turned = cross(w, u);
    const Vec<Real> p = omega > 0 ? Real(1 / omega) * turned : turned;
    const Real c = cos(angle), sine = sin(angle), rate = omega * unit;
    out.u[i] = c * u + sine * p;
    du[i] = rate * (c * p - sine * u);
    ddu[i] = Real(-rate * rate) * out.u[i];
    centre[i] = real<Real>(flight[i]->r) + time * real<Real>(flight[i]->v);
  }
  out.r = length * Vec<Real>(centre[0] - centre[1] - real<Real>(pair.shift));
  const Vec<Real> v =
      Real(length * unit) * Vec<Real>(real<Real>(flight[0]->v) - real<Real>(flight[1]->v));
  out.x = cross(out.u[0], out.u[1]);
  const Vec<Real> dx = cross(du[0], out.u[1]) + cross(out.u[0], du[1]);
  const Vec<Real> ddx =
      cross(ddu[0], out.u[1]) + Real(2) * cross(du[0], du[1]) + cross(out.u[0], ddu[1]);
  out.f = dot(out.r, out.x);
  out.df = dot(v, out.x) + dot(out.r, dx);
  out.ddf = Real(2) * dot(v, dx) + dot(out.r, ddx);
  return out;
}

}  // namespace needlework::test
