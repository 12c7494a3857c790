// The distance of the axes of two rods in free flight, with a bound on its rounding error. Rods are
// cylinders with spherical caps: their axes are segments of the half lengths of the pair, which may
// be 0, and they touch where the axes are (D1 + D2) / 2 apart.
//
// Lengths and times are scaled by powers of two of the pair's own, so that the largest distance of
// the centres at a contact lies in [1, 2) and the rods move by about 1 in a time of 1.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/closest_approach.h"
#include "kernels/contact_function.h"
#include "kernels/double_double.h"
#include "kernels/inline.h"
#include "kernels/rod_pair.h"
#include "kernels/vec3.h"

namespace needlework::kernels {

/// What bounds the motion of the axes, in scaled lengths and times. Not below.
struct RodRates {
  double velocity = 0;      ///< of a point of one axis relative to one of the other
  double acceleration = 0;  ///< the same
  double squares = 0;       ///< sum of those of the velocities of the centres and of both tips
};
template <class T>
RodRates rod_rates(const Frame<T>& frame) {
  const double w0 = to_double(frame.omega[0]), w1 = to_double(frame.omega[1]);
  const double tip0 = frame.half[0] * w0, tip1 = frame.half[1] * w1;
  return {.velocity = (frame.v_length + (tip0 + tip1)) * roundup,
          .acceleration = ((tip0 * w0 + tip1 * w1) + 2 * frame.growth * frame.v_length) * roundup,
          .squares = frame.v_length * frame.v_length + (tip0 * tip0 + tip1 * tip1)};
}

/// Both rods at one time.
template <class T>
struct RodSample {
  Vec3<T> r;              ///< first centre less the second
  Vec3<T> u[2], turn[2];  ///< directors and their rates of change
  Vec3<T> x;              ///< u1 x u2
  T arm[2];               ///< of the points where the axes are nearest
  Vec3<T> gap;            ///< from that on the second axis to that on the first
  T square;               ///< gap . gap
  T rate;                 ///< and its rate of change, while these are the nearest points
  double xx;              ///< x . x
  double error;           ///< of the length of the gap, from rounding
  double director_error;  ///< of both directors together, from rounding
};

inline double within(double a, double half) { return minimum(maximum(a, -half), half); }
inline DoubleDouble within(const DoubleDouble& a, double half) {
  if (a.hi > half || (a.hi == half && a.lo > 0)) return half;
  if (a.hi < -half || (a.hi == -half && a.lo < 0)) return -half;
  return a;
}

/// Directors whose product is shorter than this are parallel as far as T can tell.
template <class T>
inline constexpr double least_product = 0x1p-50;
template <>
inline constexpr double least_product<DoubleDouble> = 0x1p-98;

/// Sets the arms of the points where the axes are nearest, and the gap. Each point is the best for
/// the one on the other axis, so that what rounding does to the first guess matters in second order
/// only: an error d of it adds d^2 |x|^2 to the square of the distance. Next to parallel axes it is
/// large, and first order for the rate: directors that are off by e turn x by e / |x|, and so move
/// the points by e gap / |x|^2, besides e L / |x|. All points of axes that are parallel along each
/// other are equally near; those in the middle are taken.
template <class T>
NEEDLEWORK_INLINE void set_nearest(RodSample<T>& at, const double (&half)[2]) {
  const T b = dot(at.u[0], at.u[1]), r0 = dot(at.r, at.u[0]), r1 = dot(at.r, at.u[1]);
  const T xx = dot(at.x, at.x);
  at.xx = to_double(xx);
  T guess;
  if (at.xx > least_product<T> * least_product<T>) {
    guess = dot(cross(at.u[1], at.r), at.x) / xx;
  } else {
    // The second axis, along the first one.
    const double centre = -to_double(r0);
    guess = T(0.5 * (within(centre - half[1], half[0]) + within(centre + half[1], half[0])));
  }
  at.arm[1] = within(r1 + within(guess, half[0]) * b, half[1]);
  at.arm[0] = within(at.arm[1] * b - r0, half[0]);
  at.gap = at.r + (at.u[0] * at.arm[0] - at.u[1] * at.arm[1]);
  at.square = dot(at.gap, at.gap);
}

/// The rods of a frame at time s, which grow or do not.
template <bool grows, class T>
NEEDLEWORK_INLINE RodSample<T> rods_at(const Frame<T>& frame, const T& s) {
  RodSample<T> out;
  double turned = 0, off = 0;
  for (int i = 0; i < 2; ++i) {
    const T angle = frame.omega[i] * (s + frame.delay[i]);
    const SineCosine<T> sc = sine_cosine(angle);
    out.u[i] = frame.u[i] * sc.cosine + frame.p[i] * sc.sine;
    out.turn[i] = (frame.p[i] * sc.cosine - frame.u[i] * sc.sine) * frame.omega[i];
    const double of_director = 24 + 8 * std::abs(to_double(angle));
    turned += frame.half[i] * of_director;
    off += of_director;
  }
  const Centres<T> centres = centres_at<grows>(frame, s);
  out.r = centres.r;
  out.x = director_product(out.u[0], out.u[1]);
  set_nearest(out, frame.half);
  const Vec3<T> speed = centres.v + (out.turn[0] * out.arm[0] - out.turn[1] * out.arm[1]);
  const T along = dot(out.gap, speed);
  out.rate = along + along;
  // r is a difference rounded once, a product and a sum: fewer than 8 roundoffs. A director is off
  // by that of the sine and the cosine, of its phase and of the products and the sum, 24 and
  // 8 |phase| at most.
  out.error =
      unit_roundoff<T> * (8 * (frame.r_norm + frame.v_norm * std::abs(to_double(s))) + turned);
  out.director_error = unit_roundoff<T> * off;
  return out;
}
template <class T>
[[gnu::noinline, gnu::cold]] RodSample<T> growing_rods_at(const Frame<T>& frame, const T& s) {
  return rods_at<true>(frame, s);
}
template <class T>
NEEDLEWORK_INLINE RodSample<T> rods_at(const Frame<T>& frame, const T& s) {
  if (frame.growth > 0) [[unlikely]]
    return growing_rods_at(frame, s);
  return rods_at<false>(frame, s);
}

}  // namespace needlework::kernels
