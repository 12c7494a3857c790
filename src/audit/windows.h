// The windows of a run: in each the relative contact time has one value, which follows from the
// mean free time at its start.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "needlework/composition.h"
#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// Temperatures of the needles of one species, in the units in which their speeds are given.
struct Temperatures {
  double count = 0;  ///< of needles
  double t_tr = 0, t_rot = 0;
};
/// By species; 0 of one without needles.
std::vector<Temperatures> temperatures_of(std::span<const Needle> needles,
                                          std::span<const AuditedBody> bodies);
/// Of all needles.
double energy_of(std::span<const Needle> needles);

/// Mean time between two collisions of a needle at these temperatures, over all needles, by the
/// kinetic theory of hard needles: needles of species a and b collide n_a n_b sqrt(pi / 8) L_a L_b
/// <sigma> times per volume and time, sigma^2 = T_a / m_a + T_b / m_b + T_rot,a s^2 / I_a + T_rot,b
/// s'^2 / I_b averaged over the needles; half as often if a is b. The axes of rods exclude more
/// than these sides: their ends add 4 D L to L_a L_b for each of the two, and 8 D^2, where only the
/// part (L / 2)^2 (1 - mu^2) of the square of an arm counts, mu uniform. In a mixture, and among
/// rods, a needle is no partner of its own, as the engine counts. Species that pass through each
/// other do not count. Infinite if nothing moves.
double mean_free_time(std::span<const Temperatures> gas, std::span<const AuditedBody> bodies,
                      const Composition& composition, double volume);

/// Follows the ends of windows. A window begins with the run, at the end of the one before or with
/// a kick, and lasts for the power of two at or below the mean free time at its start, or the
/// interval of kicks if that is shorter. Times are in epochs.
class Windows {
 public:
  /// Relative error of the mean free time of the engine, which uses a coarse quadrature.
  static constexpr double tolerance = 4e-6;

  /// Opens the first window at time 0. `between_kicks` is their interval, or infinite.
  Windows(std::span<const Needle> needles, std::vector<AuditedBody> bodies, Composition composition,
          double volume, double between_kicks);

  /// Opens windows until the present one ends after `now`. `needles_at(time)` gives the needles as
  /// they move then.
  template <class NeedlesAt>
  void advance(const Instant& now, const NeedlesAt& needles_at) {
    while (certain_ && end_ <= now) open(end_, needles_at(end_));
  }

  /// Opens a window now, as the needles have been kicked.
  void begin_again(const Instant& now, std::span<const Needle> needles) {
    if (certain_) open(now, needles);
  }

  /// The shorter of the mean free time in the present window and the interval of kicks. [epochs]
  double usual_time() const { return std::min(mean_free_time_, between_kicks_); }
  /// In the present window. [epochs]
  double mean_free_time() const { return mean_free_time_; }
  /// Whether the ends of all windows so far are certain: no mean free time was so near a power of
  /// two that the tolerance decides.
  bool are_certain() const { return certain_; }

 private:
  void open(const Instant& now, std::span<const Needle> needles);

  std::vector<AuditedBody> bodies_;
  Composition composition_;
  double volume_, between_kicks_;
  double mean_free_time_ = 0;
  Instant end_;
  bool certain_ = true;
};

}  // namespace needlework::audit
