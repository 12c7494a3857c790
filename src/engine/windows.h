// The windows into which simulated time is divided.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "src/physics/clock.h"

namespace needlework {

/// A window is about as long as the mean free time at its start, or as the usual time of other
/// events if that is shorter. The ends of windows depend on the simulated history only. What
/// changes slowly as the gas cools is updated there and nowhere else.
class Windows {
 public:
  /// Opens a window now, at which the mean free time by kinetic theory, and the usual time of other
  /// events, are these. [time]
  void open(double mean_free_time, double usual_time, const Clock& clock, Time now) {
    set_times(measured_ > 0 ? measured_ : mean_free_time, usual_time);
    end_ = clock.add(now, span_);
  }
  /// Notes at the end of a window how many collisions and other events there have been so far.
  void count(std::uint64_t events) {
    quiet_ = events == std::exchange(events_, events) ? quiet_ + 1 : 0;
  }
  /// Notes how many collisions there have been so far, without those by the t_c rule, where kinetic
  /// theory does not give the mean free time, as in a gas that is denser at the floor: it is
  /// measured from then on.
  void measure(std::uint64_t collisions, std::size_t needles, double now) {
    // So many collisions make it good to a quarter, and so many free times without them tell that
    // it has grown.
    constexpr std::uint64_t enough = 16;
    constexpr double long_time = 64;
    const std::uint64_t counted = collisions - measured_from_;
    const double time = now - measured_since_, present = mean_free_time_;
    const bool many = counted >= enough && 8 * counted >= needles;
    if (!many && !(time > long_time * present)) return;
    measured_ = counted > 0 ? static_cast<double>(needles) * time / static_cast<double>(2 * counted)
                            : 2 * present;
    measured_from_ = collisions;
    measured_since_ = now;
  }

  Time end() const { return end_; }
  double mean_free_time() const { return mean_free_time_; }
  double span() const { return span_; }  ///< [time]
  /// Length of time ahead in which contacts are searched. [time]
  double search_span() const { return 4 * span_; }
  /// Whether no needles have collided for so long that none are expected to: for 2^20 windows, and
  /// for 2^25 / N. Kinetic theory expects a collision of every second to fourth needle in a window.
  bool are_quiet(std::uint64_t needles) const {
    return quiet_ >= long_quiet && quiet_ * needles >= 32 * long_quiet;
  }
  std::uint64_t long_quiet = std::uint64_t{1} << 20;  ///< [windows]

  /// Saves or restores what does not follow from the rest.
  template <class A>
  void transfer(A& archive) {
    double mean_free_time = mean_free_time_;
    archive(end_, mean_free_time);
    constexpr double never = std::numeric_limits<double>::infinity();
    if (archive.reads()) set_times(mean_free_time, never);
  }
  /// The same where there are effects that measure() or have usual times of their own.
  template <class A>
  void transfer_measured(A& archive) {
    double usual_time = usual_time_;
    archive(usual_time, measured_, measured_since_, measured_from_);
    if (archive.reads()) set_times(mean_free_time_, usual_time);
  }

 private:
  void set_times(double mean_free_time, double usual_time) {
    mean_free_time_ = mean_free_time;
    usual_time_ = usual_time;
    // Walls may change the energy much faster than collisions do.
    const double time = std::min(mean_free_time, usual_time);
    span_ = std::isfinite(time) ? std::ldexp(1.0, std::ilogb(time)) : time;
  }

  Time end_;
  double mean_free_time_ = 0, usual_time_ = 0, span_ = 0;
  std::uint64_t quiet_ = 0, events_ = 0;  ///< windows since the last event; events then
  double measured_ = 0;                   ///< mean free time; 0: not measured
  double measured_since_ = 0;             ///< [time]
  std::uint64_t measured_from_ = 0;       ///< collisions then
};

}  // namespace needlework
