// How a needle moves from one event to the next.
//
// Records, searches, sums and reports ask a motion for what is below and know nothing else of it.
// Only kernels look into what a record stores (kernels/contact_function.h), since they compute with
// two motions at once. The relative motion of two needles is made by Model::pair().
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "kernels/contact_function.h"
#include "kernels/power_of_two.h"
#include "src/physics/director.h"

namespace needlework {

/// The motion of a needle from one record to the next. Times are counted from when the record was
/// made. [L, time]
///
///   centre(t), director(t), velocity(t), angular_velocity(t)
///     The director is a unit vector to within rounding.
///   fastest(from, to)
///     No point of the needle's axis moves faster than fastest(from, to) plus its distance from the
///     centre times fastest_rotation(from, to), in this interval; the first is the bound for the
///     centre. So the needle travels no farther than this times to - from, which is all that
///     bounding volumes and the protocol of several threads need.
///   time_to_leave(t, low, high)
///     From t on, when it is between these two corners, how long the centre surely stays there.
///   lasts(length)
///     For how long from 0 on the numbers above are precise, for a needle of this length.
template <class M>
concept NeedleMotion = requires(const M& motion, double t, const Vec3d& corner) {
  { motion.centre(t) } -> std::same_as<Vec3d>;
  { motion.director(t) } -> std::same_as<Vec3d>;
  { motion.velocity(t) } -> std::same_as<Vec3d>;
  { motion.angular_velocity(t) } -> std::same_as<Vec3d>;
  { motion.fastest(t, t) } -> std::same_as<double>;
  { motion.fastest_rotation(t, t) } -> std::same_as<double>;
  { motion.time_to_leave(t, corner, corner) } -> std::same_as<double>;
  { motion.lasts(t) } -> std::same_as<double>;
};

/// The first time at which a point reaches `distance` >= 0 in the direction in which it flies with
/// this velocity and acceleration; infinite if it never does.
inline double time_to_reach(double distance, double velocity, double acceleration) {
  constexpr double never = std::numeric_limits<double>::infinity();
  if (distance <= 0) return 0;
  if (acceleration == 0) return velocity > 0 ? distance / velocity : never;
  const double square = velocity * velocity + 2 * acceleration * distance;
  if (square < 0) return never;
  const double root = std::sqrt(square);
  if (velocity > 0) return 2 * distance / (velocity + root);
  return acceleration > 0 ? (root - velocity) / acceleration : never;
}

/// Free flight: the centre moves along a line, or along a parabola where there is gravity, and the
/// director turns in a plane at a constant rate.
class FreeFlight {
 public:
  /// `gravity` is the acceleration, or null where there is none. [L / time^2]
  explicit FreeFlight(const kernels::Flight& flight, const Vec3d* gravity = nullptr)
      : flight_(flight), gravity_(gravity) {}

  Vec3d centre(double t) const {
    const Vec3d along = centre_after(flight_, t);
    return gravity_ ? along + *gravity_ * (0.5 * t * t) : along;
  }
  Vec3d director(double t) const { return director_after(flight_, t); }
  Vec3d velocity(double t) const { return gravity_ ? flight_.v + *gravity_ * t : flight_.v; }
  Vec3d angular_velocity(double) const { return flight_.w; }
  double fastest(double from, double to) const {
    // The square of the speed is convex in time.
    const double first = length_of(velocity(from));
    return gravity_ ? std::max(first, length_of(velocity(to))) : first;
  }
  double fastest_rotation(double, double) const { return flight_.omega; }
  double time_to_leave(double t, const Vec3d& low, const Vec3d& high) const {
    const Vec3d r = centre(t);
    double out = std::numeric_limits<double>::infinity();
    if (gravity_) {
      const Vec3d v = velocity(t);
      const auto falling = [&](double place, double speed, double pull, double from, double to) {
        out = std::min({out, time_to_reach(to - place, speed, pull),
                        time_to_reach(place - from, -speed, -pull)});
      };
      falling(r.x, v.x, gravity_->x, low.x, high.x);
      falling(r.y, v.y, gravity_->y, low.y, high.y);
      falling(r.z, v.z, gravity_->z, low.z, high.z);
      return out;
    }
    const auto along = [&](double place, double speed, double from, double to) {
      if (speed > 0) {
        out = std::min(out, (to - place) / speed);
      } else if (speed < 0) {
        out = std::min(out, (from - place) / speed);
      }
    };
    along(r.x, flight_.v.x, low.x, high.x);
    along(r.y, flight_.v.y, low.y, high.y);
    along(r.z, flight_.v.z, low.z, high.z);
    return std::max(out, 0.0);
  }
  /// About 2^10 lengths or radians: a power of two, so that scaling velocities by one is exact.
  /// Where there is gravity, until the speed may be about three times that at first, or that of a
  /// fall through the length, so that fastest() is of use.
  double lasts(double length) const {
    const Vec3d& v = flight_.v;
    // Lengths per time are scaled by powers of two, so that scaling lengths by one is exact, too.
    const double per_length = times_power_of_two(1.0, -exponent_of(length));
    const double speed = std::max(
        std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) * per_length, flight_.omega);
    const double straight = speed == 0 ? std::numeric_limits<double>::infinity()
                                       : times_power_of_two(1.0, 10 - exponent_of(speed));
    if (!gravity_) return straight;
    const double pull = length_of(*gravity_);
    const double gain = std::max(length_of(v), std::sqrt(pull * length));
    return std::min(straight, times_power_of_two(1.0, 1 + exponent_of(gain) - exponent_of(pull)));
  }

 private:
  static double length_of(const Vec3d& a) { return std::sqrt(dot(a, a)); }

  const kernels::Flight& flight_;
  const Vec3d* gravity_;
};

static_assert(NeedleMotion<FreeFlight>);

/// A motion as of one time, from which on times are counted.
template <NeedleMotion M>
struct MotionFrom {
  M motion;
  double start;  ///< since the record was made [time]

  Vec3d centre() const { return motion.centre(start); }
  Vec3d director() const { return motion.director(start); }
  Vec3d velocity() const { return motion.velocity(start); }
  Vec3d angular_velocity() const { return motion.angular_velocity(start); }
  /// The director as a unit vector; that of the record itself where no time has passed.
  Vec3d unit_director() const { return start == 0 ? director() : normalised(director()); }
};

}  // namespace needlework
