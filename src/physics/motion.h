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

/// Free flight: the centre moves along a line, and the director turns in a plane at a constant
/// rate.
class FreeFlight {
 public:
  explicit FreeFlight(const kernels::Flight& flight) : flight_(flight) {}

  Vec3d centre(double t) const { return centre_after(flight_, t); }
  Vec3d director(double t) const { return director_after(flight_, t); }
  Vec3d velocity(double) const { return flight_.v; }
  Vec3d angular_velocity(double) const { return flight_.w; }
  double fastest(double, double) const { return std::sqrt(dot(flight_.v, flight_.v)); }
  double fastest_rotation(double, double) const { return flight_.omega; }
  double time_to_leave(double t, const Vec3d& low, const Vec3d& high) const {
    const Vec3d r = centre(t);
    double out = std::numeric_limits<double>::infinity();
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
  double lasts(double length) const {
    const Vec3d& v = flight_.v;
    // Lengths per time are scaled by powers of two, so that scaling lengths by one is exact, too.
    const double per_length = times_power_of_two(1.0, -exponent_of(length));
    const double speed = std::max(
        std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) * per_length, flight_.omega);
    if (speed == 0) return std::numeric_limits<double>::infinity();
    return times_power_of_two(1.0, 10 - exponent_of(speed));
  }

 private:
  const kernels::Flight& flight_;
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
