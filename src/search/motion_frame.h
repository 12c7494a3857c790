// Units, origin of times and frame of reference of the motions that SIMD kernels read.
//
// Why kernels may take paths for straight: where there is gravity, motions and the words of cells
// are those seen from a frame that falls with all bodies and is at rest at `base`, and relative
// motion is the same in every frame. Cells and capsules are at rest themselves. What is compared
// with them leaves room for the fall since `base`, which ends before it exceeds what words can
// hold, or for that during a search, bend().
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/near_needles.h"
#include "src/physics/gas.h"
#include "src/search/lengths.h"

namespace needlework {

/// Lengths are in units of 1 / per_length, times in units of 1 / per_time and counted from `base`;
/// both are powers of two.
struct MotionFrame {
  struct Path {
    Vec3d centre, velocity;
  };
  struct Range {
    float low, high;
  };

  explicit MotionFrame(const Gas& its_gas)
      : gas(its_gas), falls(its_gas.falls), per_length(1 / unit_of_length(its_gas)) {}

  /// Chooses the unit of time from the speeds of now, which becomes the origin. The frame may fall
  /// by `most_fallen` until longest_time. [L]
  void begin(Time now, double most_fallen);
  /// By how much the frame of a class may fall: by shares of sides of cells or lengths of needles.
  /// 0 without gravity. [L]
  double most_fallen(double side, double longest) const;

  double since_base(Time t) const { return gas.clock.difference(t, base) * per_time; }
  /// Not before the time. [unit of time]
  float rounded_up(Time t) const { return static_cast<float>(since_base(t) * (1 + 0x1p-20)); }
  /// Whether a needle can be placed at this time.
  bool holds(Time t) const { return per_time != 0 && since_base(t) <= longest_time; }
  Time end() const { return gas.clock.add(base, longest_time / per_time); }

  // With `falls` as a constant, the compiler knows where there is no gravity.

  template <bool falls>
  FreeFlight flight_of(const kernels::Flight& flight) const {
    return FreeFlight(flight, falls ? &gas.gravity : nullptr);
  }
  /// The motion in this frame of what is here now with this velocity.
  Path path_of(const Vec3d& centre, const Vec3d& velocity, Time now) const {
    return falls ? path_of<true>(centre, velocity, now) : path_of<false>(centre, velocity, now);
  }
  template <bool falls>
  Path path_of(const Vec3d& centre, const Vec3d& velocity, Time now) const {
    if (!falls) return {centre, velocity};
    const double time = gas.clock.difference(now, base);
    return {centre - gas.gravity * (0.5 * time * time), velocity - gas.gravity * time};
  }
  /// Half the longest time in whose middle a point with this speed may be, if it is to be within
  /// `radius` of that place all the time. [time]
  template <bool falls>
  double half_time_within(double radius, double speed) const {
    if (!falls) return radius / speed;
    // The speed in the middle is greater by up to |g| half, and changes by as much from there on.
    const double pull = std::sqrt(dot(gas.gravity, gas.gravity));
    return 2 * radius / (speed + std::sqrt(speed * speed + 6 * pull * radius));
  }

  /// Where the centre of a seeker gets to along an axis in a time ahead, at rest. [unit of length]
  Range along(int axis, const kernels::Seeker& seeker, float ahead) const {
    return falls ? along_curve(axis, seeker, ahead) : along_line(axis, seeker, ahead);
  }
  /// The same as this frame sees it.
  static Range along_line(int axis, const kernels::Seeker& seeker, float ahead) {
    const float moved = seeker.motion.v[axis] * ahead;
    return {seeker.motion.r[axis] + std::min(moved, 0.0f),
            seeker.motion.r[axis] + std::max(moved, 0.0f)};
  }
  /// How far the two are apart in the time that the seeker searches ahead. [unit of length]
  float bend(const kernels::Seeker& seeker, double at_most) const {
    const double time = (seeker.now + seeker.ahead) / per_time;
    const double fallen = 0.5 * std::sqrt(dot(gas.gravity, gas.gravity)) * time * time;
    return static_cast<float>(std::min(fallen, at_most) * per_length);
  }

  const Gas& gas;
  const bool falls;                             ///< whether there is gravity
  double per_length;                            ///< 1 / unit of length
  double per_time = 0;                          ///< 1 / unit of time; 0 before the first needle
  double longest_time = kernels::longest_time;  ///< largest present time [unit of time]
  Time base;

 private:
  Range along_curve(int axis, const kernels::Seeker& seeker, float ahead) const;
};

}  // namespace needlework
