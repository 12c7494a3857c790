// What the distance of two rods does between two times.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "kernels/rod_instants.h"

namespace needlework::kernels {

/// Each answer depends on the two instants alone, and is never yes unless that is certain.
class RodStretches {
 public:
  explicit RodStretches(RodInstants& rods) : rods_(rods) {}

  /// Whether the excess stays above 0 between a and b, for the chord and the curvature. `noise`
  /// times the errors is taken off. Where the pair touches at a, it must leave 0 for good.
  template <class T>
  bool stays_above_chord(const Instant<T>& a, const Instant<T>& b, double noise) const;
  /// Whether the rods stay apart between a and b, for the plane through the nearest points at a.
  template <class T>
  bool stays_beyond_plane(const Instant<T>& a, const Instant<T>& b, bool starts);
  /// Whether they do for a time h from a on.
  bool stays_apart_for(const Instant<double>& a, double h) const;
  /// Whether the distance falls throughout from a to b.
  template <class T>
  bool falls(const Instant<T>& a, const Instant<T>& b) const;
  /// Whether rounding hides what the distance does between a and b.
  template <class T>
  bool is_limited_by_rounding(const Instant<T>& a, const Instant<T>& b) const;

 private:
  // Where rounding is no smaller a share of the curvature than this, an interval goes to
  // double-double.
  static constexpr double least_share = 0x1p-6;

  const Frame<double>& frame() const { return rods_.frame<double>(); }
  // The second derivative of n . r is not above this where bodies grow.
  double of_growth(const Vec3d& n) const {
    const double rounding = 8 * unit_roundoff<double> * frame().v_norm;
    return 2 * frame().growth * (std::abs(dot(n, frame().v)) + rounding);
  }

  RodInstants& rods_;
};

template <class T>
bool RodStretches::stays_above_chord(const Instant<T>& a, const Instant<T>& b, double noise) const {
  const double h = to_double(b.s - a.s);
  const double speed = rods_.speed_between(a, b);
  const double c = rods_.curvature(speed, 0.5 * (a.distance + b.distance + speed * h));
  const double after = b.excess - noise * b.error;
  if (rods_.starts_at(a)) return after > 0.5 * c * h * h;
  const double before = a.excess - noise * a.error;
  if (!(before > 0 && after > 0)) return false;
  // before + slope t + c t^2 / 2
  const double slope = (after - before) / h - 0.5 * c * h;
  if (slope >= 0 || slope + c * h <= 0) return true;
  return 2 * c * before > slope * slope * roundup;
}

// The distance is not below n . r - half1 |n . u1| - half2 |n . u2| for any unit vector n, in which
// r is linear, or departs from its chord as growth allows, and each n . u departs from its chord by
// no more than its second derivative allows.
template <class T>
bool RodStretches::stays_beyond_plane(const Instant<T>& a, const Instant<T>& b, bool starts) {
  if (!(a.distance > 0)) return false;
  T length, contact;
  if constexpr (std::is_same_v<T, double>) {
    length = a.distance;
    contact = std::sqrt(rods_.threshold<double>() + rods_.threshold_error()) * roundup;
  } else {
    length = sqrt(a.rods.square);
    contact = sqrt(rods_.template threshold<T>());
  }
  const T per_length = T(1.0) / length;
  const Vec3<T> n = a.rods.gap * per_length;
  T beyond = dot(n, b.rods.r) - contact;
  double bend = 0;
  for (int i = 0; i < 2; ++i) {
    const double half = frame().half[i];
    const T along = dot(n, b.rods.u[i]);
    beyond = beyond - (to_double(along) < 0 ? -along : along) * T(half);
    const double omega = frame().omega[i];
    const double cosine = omega * to_double(dot(n, a.rods.u[i])),
                 sine = to_double(dot(n, a.rods.turn[i]));
    bend += half * omega * std::sqrt(cosine * cosine + sine * sine);
  }
  if (frame().growth > 0) bend += of_growth(to_double(n));
  const double h = to_double(b.s - a.s);
  const double error = 2 * (a.rods.error + b.rods.error);
  // What double-double does not tell from a touch is none of the contacts.
  const double noise = std::is_same_v<T, double> ? error : -error;
  if (starts) return to_double(beyond) - error > 0.5 * bend * h * h * roundup;
  const double least = std::min(to_double(length - contact), to_double(beyond));
  return least - noise > 0.125 * bend * h * h * roundup;
}

inline bool RodStretches::stays_apart_for(const Instant<double>& a, double h) const {
  if (!(a.excess > a.error)) return false;
  const Vec3d n = a.rods.gap * (1 / a.distance);
  const Vec3d v = frame().growth > 0 ? centres_at<true>(frame(), a.s).v : frame().v;
  double beyond = dot(n, a.rods.r) + dot(n, v) * h, bend = 0;
  for (int i = 0; i < 2; ++i) {
    const double half = frame().half[i], omega = frame().omega[i];
    const double along = dot(n, a.rods.u[i]), turn = dot(n, a.rods.turn[i]);
    beyond -= half * std::abs(along + turn * h);
    bend += half * omega * std::sqrt(omega * along * (omega * along) + turn * turn);
  }
  if (frame().growth > 0) bend += of_growth(n);
  const double noise = 0x1p-40 * (frame().r_norm + rods_.rates().velocity * (std::abs(a.s) + h));
  return beyond - 0.5 * bend * h * h * roundup >
         rods_.distance() * roundup + 4 * a.rods.error + noise;
}

template <class T>
bool RodStretches::falls(const Instant<T>& a, const Instant<T>& b) const {
  return 0.75 * a.rate + a.rate_error +
             rods_.curvature(rods_.speed_between(a, b), a.distance) * to_double(b.s - a.s) <
         0;
}

template <class T>
bool RodStretches::is_limited_by_rounding(const Instant<T>& a, const Instant<T>& b) const {
  const double h = to_double(b.s - a.s), error = std::max(a.error, b.error);
  const double bend =
      0.125 * rods_.curvature(rods_.speed_between(a, b), std::max(a.distance, b.distance)) * h * h;
  if (least_share * bend < error) return true;
  const double enough = 1 / least_share;
  return std::abs(a.excess) < enough * a.error && std::abs(b.excess) < enough * b.error;
}

}  // namespace needlework::kernels
