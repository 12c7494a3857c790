// The contact function of two needles in free flight,
//
//     f(s) = r12(s) . (u1(s) x u2(s)),
//
// whose changes of sign with both contact points inside the needles are the collisions. s is time
// since the later of the two records. Lengths and times are scaled by powers of two of the pair's
// own, so that the sum of the half lengths and |v12| + |w1| + |w2| are about 1: no tolerance below
// refers to a unit of length or of time.
//
// One template serves double, double-double and intervals; each value of the former two comes with
// a bound on its rounding error, the rounding of its inputs to T included, relative to the records
// taken as exact numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "kernels/double_double.h"
#include "kernels/ieee_arithmetic.h"
#include "kernels/range.h"
#include "kernels/sine_cosine.h"
#include "kernels/vec3.h"

namespace needlework::kernels {

/// A needle's free flight since its record: r(t) = r + v t, u(t) = u cos(|w| t) + p sin(|w| t).
/// Of a sphere u is at rest, as it marks nothing.
struct Flight {
  Vec3d r;           ///< centre [L]
  Vec3d v;           ///< velocity [L / time]
  Vec3d u;           ///< director
  Vec3d w;           ///< angular velocity, normal to u unless it is that of a sphere [1 / time]
  Vec3d p;           ///< w x u / |w|, or 0
  double omega = 0;  ///< |w|; 0 of spheres
};

/// Fills in p and omega from u and w, of a needle or rod.
void set_rotation(Flight& flight);

/// Centre and director after `elapsed`.
inline Vec3d centre_after(const Flight& flight, double elapsed) {
  return flight.r + flight.v * elapsed;
}
Vec3d director_after(const Flight& flight, double elapsed);

/// What is kept of a touch of two needles at s = 0: the contact function is continued from the
/// value it had, so that rounding a record never moves a needle to the other side of its neighbour.
struct Touch {
  bool touching = false;
  bool collided = false;  ///< the touch at s = 0 was a collision: gap 0, separating
  int side = 0;           ///< sign of f just after s = 0
  double gap = 0;         ///< f(0) [L]
};

/// What a common acceleration has done, from its record to s = 0, to the needle whose record is the
/// earlier one: the change of the relative velocity and place, those of the first needle less those
/// of the second. From s = 0 on both fall alike.
struct Fall {
  Vec3dd velocity;  ///< [L / time]
  Vec3dd place;     ///< [L]
};

/// Two needles and one periodic image. Exchanging the needles and negating `shift` changes no bit
/// of any result.
struct Pair {
  const Flight* first = nullptr;
  const Flight* second = nullptr;
  DoubleDouble elapsed_first;   ///< s = 0 is this long after the first needle's record [time]
  DoubleDouble elapsed_second;  ///< one of the two is 0
  Vec3dd shift;                 ///< added to the second needle's centre [L]
  std::optional<Fall> fall;     ///< if there is a common acceleration
  double half_first = 0.5, half_second = 0.5;  ///< half lengths of the needles [L]
  Touch touch;
  double touch_within = 0;  ///< |f(0)| that rounding of the records can explain; 0: none [L]
};

/// r1 - r2 - shift at s = 0. Exchanging the needles negates it exactly. [L]
Vec3dd separation(const Pair& pair);

/// v1 - v2 from s = 0 on, of a pair that has fallen. What it has gained may nearly cancel the rest.
/// [L / time]
Vec3dd falling_velocity(const Pair& pair);

/// Powers of two that scale a pair: lengths times `per_length` make the sum of the half lengths lie
/// in [1, 2); times times `per_time`, and rates (1 / time) times `per_rate`, make the pair's rate
/// of change about 1.
struct PairScale {
  bool moves = false;     ///< false when neither needle moves relative to the other
  double per_rate = 1;    ///< 1 / per_time
  double per_time = 1;    ///< scaled time per time
  double per_length = 1;  ///< scaled length per length

  double per_velocity() const { return per_length * per_rate; }
};
PairScale scale_of(const Pair& pair);
/// The same for lengths that are scaled by another power of two, and for parts that move at this
/// rate, in such lengths, beside the centres.
PairScale scale_of(const Pair& pair, double per_length, double turning);

/// Bounds computed with a few roundings are enlarged by this.
inline constexpr double roundup = 1 + 0x1p-40;

template <class T>
inline constexpr double unit_roundoff = 0x1p-53;
template <>
inline constexpr double unit_roundoff<DoubleDouble> = 0x1p-102;

/// The pair in scaled lengths and scaled time, seen from s = 0.
template <class T>
struct Frame {
  Vec3<T> r, v;        ///< r1 - r2 - shift and v1 - v2
  Vec3<T> u[2], p[2];  ///< at the records
  T omega[2], delay[2];
  T offset{}, slope{};      ///< continuation from a touch: f + offset + slope s is what counts
  double offset_error = 0;  ///< of the offset, in double
  double r_norm = 0, v_norm = 0, w_sum = 0;  ///< |r|, |v| and omega1 + omega2, not below
  double v_length = 0;                       ///< 2-norm of v, not below
  double half[2] = {0.5, 0.5};               ///< half lengths
  double growth = 0;  ///< of bodies that grow (kernels/rod_pair.h), per scaled time
};

template <class T>
Frame<T> make_frame(const Pair& pair, const PairScale& scale);

/// Encloses the frame of this pair, made to double-double precision.
Frame<Range> enclose(const Frame<DoubleDouble>& frame, const Pair& pair, const PairScale& scale);

/// f with two derivatives and bounds on their errors at one time.
struct Estimate {
  double f, df, ddf;
  double error_f, error_df, error_ddf;
  double distance;  ///< |r12|
};

/// Geometry at one time, from which the estimate and the arms follow.
template <class T>
struct Sample {
  Vec3<T> u[2], r, x, dx;
  T f, df, ddf;
  double phase;  ///< sum of both phase angles, for the error bounds
};

/// u1 x u2. What double cannot decide is mostly about directors that are nearly parallel, where the
/// product loses all digits that they share; (u1 - u2) x (u1 + u2) / 2 loses none.
template <class T>
Vec3<T> director_product(const Vec3<T>& u1, const Vec3<T>& u2) {
  if constexpr (std::is_same_v<T, DoubleDouble>) {
    return cross(u1 - u2, (u1 + u2) * T(0.5));
  } else {
    return cross(u1, u2);
  }
}

template <class T>
Sample<T> evaluate(const Frame<T>& frame, const T& s) {
  Sample<T> out;
  Vec3<T> d[2];
  double phase = 0;
  for (int i = 0; i < 2; ++i) {
    const T angle = frame.omega[i] * (s + frame.delay[i]);
    const SineCosine<T> sc = sine_cosine(angle);
    out.u[i] = frame.u[i] * sc.cosine + frame.p[i] * sc.sine;
    d[i] = (frame.p[i] * sc.cosine - frame.u[i] * sc.sine) * frame.omega[i];
    phase += std::abs(to_double(angle));
  }
  out.phase = phase;
  out.r = frame.r + frame.v * s;
  out.x = director_product(out.u[0], out.u[1]);
  out.dx = cross(d[0], out.u[1]) + cross(out.u[0], d[1]);
  const Vec3<T> rate_product = cross(d[0], d[1]);
  const T w2 = frame.omega[0] * frame.omega[0] + frame.omega[1] * frame.omega[1];
  const Vec3<T> ddx = rate_product + rate_product - out.x * w2;
  const T vdx = dot(frame.v, out.dx);
  out.f = dot(out.r, out.x) + (frame.offset + frame.slope * s);
  out.df = (dot(frame.v, out.x) + dot(out.r, out.dx)) + frame.slope;
  out.ddf = (vdx + vdx) + dot(out.r, ddx);
  return out;
}

/// Error of each director component and of products of them, in units of 1; see the derivation at
/// the definition of `estimate`.
template <class T>
double director_error(const Sample<T>& sample) {
  return unit_roundoff<T> * (32 + 8 * sample.phase);
}

template <class T>
Estimate estimate(const Frame<T>& frame, const T& s, const Sample<T>& sample) {
  // A phase w (s + delay) carries the relative errors of w, delay, sum and product and the absolute
  // one of sine and cosine: 8 |phase| roundoffs cover them. p, u and their products add fewer than
  // 16 for each needle. r is a difference rounded once, then a product and a sum: 4 roundoffs of
  // |r| + |v| |s|. Scalar products of three terms add 3.
  const double eu = director_error(sample);
  const double rounding = 16 * unit_roundoff<T>;
  const double r = frame.r_norm + frame.v_norm * std::abs(to_double(s));
  const double w = frame.w_sum;
  const double offset =
      std::abs(to_double(frame.offset)) + std::abs(to_double(frame.slope) * to_double(s));
  Estimate out;
  out.f = to_double(sample.f);
  out.df = to_double(sample.df);
  out.ddf = to_double(sample.ddf);
  out.distance = std::sqrt(to_double(dot(sample.r, sample.r)));
  if constexpr (std::is_same_v<T, DoubleDouble>) {
    // f is off by |x| times what r is, by |u2 x r| and |u1 x r| times what the directors are, and
    // by |r| times the rounding of x, whose factors are as exact as the directors. All of
    // these errors, like f itself, vanish to second order as the needles approach one line.
    const Vec3d centres = to_double(sample.r);
    const auto arm = [&](const Vec3<T>& u) {
      const Vec3d c = cross(to_double(u), centres);
      return std::sqrt(dot(c, c)) + 0x1p-50 * out.distance;
    };
    const double x = std::sqrt(to_double(dot(sample.x, sample.x))) * roundup + 4 * eu;
    out.error_f = rounding * ((r + out.distance) * x + offset) +
                  eu * (std::max(arm(sample.u[0]), arm(sample.u[1])) * roundup) +
                  frame.offset_error;
  } else {
    // |x| <= 1, so that f is off by what r is, and by |r| times what x and their product are.
    out.error_f = rounding * (r + offset) + (out.distance + rounding * r) * (eu + rounding) +
                  frame.offset_error;
  }
  out.error_df = 2 * (frame.v_norm + r * w) * (eu + rounding);
  out.error_ddf = 3 * (2 * frame.v_norm + r * w) * w * (eu + rounding);
  return out;
}

/// |f'''| is not above this from `off` before the time of e to as much after it.
template <class T>
double third_derivative_bound(const Frame<T>& frame, const Estimate& e, double off) {
  const double w = frame.w_sum, v = frame.v_length;
  return (3 * v + (e.distance + v * off) * w) * w * w;
}

/// The estimate at a time later by `off`, or earlier, by Taylor's expansion.
/// |f'''| is not above `third` between. The distance remains that of e.
Estimate expanded(const Estimate& e, double off, double third);

/// f as the sum of a slow and a fast part, each (a + b s) times sines and cosines of one frequency,
/// |w1| - |w2| and |w1| + |w2|: bounds on f's derivatives for needles that stay close to one plane
/// or parallel, where bounds by |r|, |v| and the sum of the frequencies are far too large.
struct Amplitude {
  struct Part {
    double a, b;  ///< sums of the magnitudes of the coefficients
    double w;     ///< frequency
  };
  Part slow, fast;

  /// Bound on the derivative of order n, 2 or 3, for times in [0, s].
  double derivative_bound(int n, double s) const;
};
Amplitude amplitude(const Frame<DoubleDouble>& frame);

}  // namespace needlework::kernels
