// The windows of a run: in each the relative contact time has one value, which follows from the
// mean free time at its start.
#pragma once

#include <cstddef>
#include <span>

#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// Temperatures of needles of length and mass 1, in units of time in which their speeds are given.
struct Temperatures {
  double t_tr = 0, t_rot = 0;
  double energy() const { return 1.5 * t_tr + t_rot; }  ///< per needle
};
Temperatures temperatures_of(std::span<const Needle> needles, double k);

/// Mean time between two collisions of a needle at these temperatures, by the kinetic theory of
/// hard needles: 1 / (n (sqrt(pi) / 2) integral over the unit square of sqrt(T_tr + T_rot k r^2)).
/// Infinite if nothing moves.
double mean_free_time(const Temperatures& gas, double density, double k);

/// Follows the ends of windows. A window begins with the run or at the end of the one before, and
/// lasts for the power of two at or below the mean free time at its start. Times are in epochs.
class Windows {
 public:
  /// Relative error of the mean free time of the engine, which uses a coarse quadrature.
  static constexpr double tolerance = 4e-6;

  /// Opens the first window at time 0; `density` is a number per volume.
  Windows(std::span<const Needle> needles, double density, double k);

  /// Opens windows until the present one ends after `now`. The needles move as given until then.
  void advance(const Instant& now, std::span<const Needle> needles);

  /// In the present window. [epochs]
  double mean_free_time() const { return mean_free_time_; }
  /// Whether the ends of all windows so far are certain: no mean free time was so near a power of
  /// two that the tolerance decides.
  bool are_certain() const { return certain_; }

 private:
  void open(const Instant& now, std::span<const Needle> needles);

  double density_, k_;
  double mean_free_time_ = 0;
  Instant end_;
  bool certain_ = true;
};

}  // namespace needlework::audit
