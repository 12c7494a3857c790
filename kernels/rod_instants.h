// Two rods at one time after another: how far their distance is from that at contact, in double and
// in double-double, with bounds on what rounding does to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "kernels/first_contact.h"
#include "kernels/rod_distance.h"
#include "kernels/rod_pair.h"

namespace needlework::kernels {

/// The rods at one time, and the square of their distance less that at contact.
template <class T>
struct Instant {
  T s;
  RodSample<T> rods;
  double distance;
  double excess, error;
  double rate, rate_error;  ///< of the excess
  double speed;             ///< of a point of one axis relative to one of the other, not below
};

/// Below this share of the pair's speeds, the velocity at which it separates is rounding.
inline constexpr double rod_velocity_noise = 0x1p-46;

/// The pair in scaled lengths and time. It counts its evaluations.
class RodInstants {
 public:
  RodInstants(const RodPair& pair, EvaluationCounters& counters)
      : pair_(pair),
        counters_(counters),
        scale_(rod_scale_of(pair)),
        frame_(rod_frame<double>(pair, scale_)),
        rates_(rod_rates(frame_)),
        distance_(pair.distance * scale_.per_length),
        threshold_(distance_ * distance_),
        threshold_error_(unit_roundoff<double> * threshold_) {}
  RodInstants(const RodInstants&) = delete;
  RodInstants& operator=(const RodInstants&) = delete;

  const RodPair& pair() const { return pair_; }
  const PairScale& scale() const { return scale_; }
  const RodRates& rates() const { return rates_; }
  /// Of the axes at contact, where rounding of the records does not count.
  double distance() const { return distance_; }

  template <class T>
  const Frame<T>& frame();
  /// Square of the distance at which contact is.
  template <class T>
  T threshold();
  double threshold_error() const { return threshold_error_; }  ///< of the one in double
  template <class T>
  [[gnu::noinline]] Instant<T> at(const T& s) {
    if (frame_.growth > 0) [[unlikely]]
      return growing(s);
    return instant<false>(s);
  }

  /// Takes up how the rods are at s = 0: where they touch there to within rounding, the distance at
  /// contact may be the one that they have then.
  void begin(const Instant<double>& start);
  /// Whether they do.
  bool are_touching() const { return touching_; }
  /// Whether the search between this time and later ones begins at such a touch.
  template <class T>
  bool starts_at(const Instant<T>& a) const {
    return touching_ && to_double(a.s) == 0 &&
           !(std::is_same_v<T, DoubleDouble> && a.excess > a.error);
  }
  /// Whether the rods are nearer than rounding of their records explains.
  bool overlaps(const Instant<double>& at) const;
  /// The second derivative of the square of the distance is not above this where the speed and the
  /// distance are not.
  double curvature(double speed, double distance) const {
    return 2 * (speed * speed + distance * rates_.acceleration) * roundup;
  }
  /// A rate of the excess at s = 0 that rounding of the velocities and of the normal may explain.
  double noise_of_rate(const Instant<double>& start) const {
    return 2 * rates_.velocity * (rod_velocity_noise * start.distance + start.rods.error);
  }
  /// Speeds between a and b are not above this.
  template <class T>
  double speed_between(const Instant<T>& a, const Instant<T>& b) const {
    return 0.5 * ((a.speed + b.speed) + rates_.acceleration * std::abs(to_double(b.s - a.s)));
  }

 private:
  template <bool grows, class T>
  NEEDLEWORK_INLINE Instant<T> instant(const T& s);
  template <class T>
  [[gnu::noinline, gnu::cold]] Instant<T> growing(const T& s) {
    return instant<true>(s);
  }
  double largest_speed(const Vec3d& v, const Vec3d& first_turn, const Vec3d& second_turn) const;
  template <class T>
  double rate_error_of(const Instant<T>& now) const;

  const RodPair& pair_;
  EvaluationCounters& counters_;
  PairScale scale_;
  Frame<double> frame_;
  RodRates rates_;
  std::optional<Frame<DoubleDouble>> precise_frame_;
  double distance_;
  double threshold_, threshold_error_;
  std::optional<DoubleDouble> precise_threshold_;
  bool touching_ = false;  // at s = 0, to within rounding
};

template <class T>
const Frame<T>& RodInstants::frame() {
  if constexpr (std::is_same_v<T, double>) {
    return frame_;
  } else {
    if (!precise_frame_) precise_frame_ = rod_frame<DoubleDouble>(pair_, scale_);
    return *precise_frame_;
  }
}

template <class T>
T RodInstants::threshold() {
  if constexpr (std::is_same_v<T, double>) {
    return threshold_;
  } else {
    if (!precise_threshold_) {
      precise_threshold_ = two_prod(distance_, distance_);
      if (touching_) {
        ++counters_.escalated;
        const DoubleDouble now = rods_at(frame<DoubleDouble>(), DoubleDouble()).square;
        if (to_double(now - *precise_threshold_) < 0) precise_threshold_ = now;
      }
    }
    return *precise_threshold_;
  }
}

template <bool grows, class T>
NEEDLEWORK_INLINE Instant<T> RodInstants::instant(const T& s) {
  ++(std::is_same_v<T, double> ? counters_.evaluated : counters_.escalated);
  Instant<T> out;
  out.s = s;
  out.rods = rods_at<grows>(frame<T>(), s);
  const double square = to_double(out.rods.square);
  out.distance = std::sqrt(square);
  out.excess = to_double(out.rods.square - threshold<T>());
  const double length = out.rods.error;
  out.error = (2 * out.distance + length) * length + 4 * unit_roundoff<T> * square;
  if constexpr (std::is_same_v<T, double>) out.error += threshold_error_;
  out.rate = to_double(out.rods.rate);
  const auto speed_with = [&](const Vec3d& v) {
    return largest_speed(v, to_double(out.rods.turn[0]), to_double(out.rods.turn[1]));
  };
  if constexpr (grows)
    out.speed = speed_with(centres_at<true>(frame_, to_double(s)).v);
  else
    out.speed = speed_with(frame_.v);
  out.rate_error = rate_error_of(out);
  return out;
}

// From errors of the gap, of the velocity and of the points at which both are taken.
template <class T>
double RodInstants::rate_error_of(const Instant<T>& now) const {
  const double all = frame_.half[0] + frame_.half[1], x = std::sqrt(now.rods.xx);
  const double off = now.rods.director_error * (now.distance + all * x);
  const double arms = off < all * now.rods.xx ? off / now.rods.xx : all;
  return 2 * (now.speed * (now.rods.error + arms * x) +
              now.distance * (32 * unit_roundoff<T> * rates_.velocity + frame_.w_sum * arms));
}

// That of two tips, since the velocity is linear in the places on both axes.
inline double RodInstants::largest_speed(const Vec3d& v, const Vec3d& first_turn,
                                         const Vec3d& second_turn) const {
  const double half0 = frame_.half[0], half1 = frame_.half[1];
  const double v0 = half0 * dot(v, first_turn), v1 = half1 * dot(v, second_turn),
               both = half0 * half1 * dot(first_turn, second_turn);
  const double most = std::max(std::abs(v0 + v1) + both, std::abs(v0 - v1) - both);
  return std::sqrt((rates_.squares + 2 * most) * roundup);
}

inline void RodInstants::begin(const Instant<double>& start) {
  touching_ = start.excess <= start.error;
  if (!touching_) return;
  threshold_ = std::min(threshold_, to_double(start.rods.square));
  threshold_error_ += start.error;
}

inline bool RodInstants::overlaps(const Instant<double>& at) const {
  return distance_ - at.distance > rod_allowance_of(pair_) * scale_.per_length + at.rods.error;
}

/// That rods are nearer at s = 0 than rounding explains.
inline Contact overlap_found() {
  return {.found = true, .unresolvable = true, .overlap = true, .elapsed = {}, .side = 1};
}

/// Whether rods that have just collided part with no more velocity than rounding may have left
/// them, and meet again with no more than they gain over the gap that it may have left.
inline bool returns_by_rounding(RodInstants& rods, const DoubleDouble& root) {
  if (root.hi == 0) return true;
  const Instant<double> start = rods.at(0.0);
  const double noise = 4 * rods.noise_of_rate(start);
  if (start.rate - start.rate_error > 4 * noise || rods.at(DoubleDouble()).rate > noise)
    return false;
  const double gained = 64 * rods.curvature(start.speed, start.distance) * start.error;
  const double rate = rods.at(root).rate;
  return rate * rate <= noise * noise + gained;
}

/// The contact at this root, in scaled time, if that is not after the end.
inline Contact contact_at(RodInstants& rods, const DoubleDouble& root, double end) {
  if (root.hi > end) return {};
  return {.found = true,
          .unresolvable = rods.pair().touch.collided && returns_by_rounding(rods, root),
          .elapsed = {root.hi * rods.scale().per_rate, root.lo * rods.scale().per_rate},
          .side = 1};
}

}  // namespace needlework::kernels
