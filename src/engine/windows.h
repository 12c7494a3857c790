// The windows into which simulated time is divided.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "src/physics/clock.h"

namespace needlework {

/// A window is about as long as the mean free time at its start. The ends of windows depend on the
/// simulated history only. What changes slowly as the gas cools is updated there and nowhere else.
class Windows {
 public:
  /// Opens a window now, at which the mean free time is this. [time]
  void open(double mean_free_time, const Clock& clock, Time now) {
    set_mean_free_time(mean_free_time);
    end_ = clock.add(now, span_);
  }
  /// Notes at the end of a window how many collisions there have been so far.
  void count(std::uint64_t collisions) {
    quiet_ = collisions == std::exchange(collisions_, collisions) ? quiet_ + 1 : 0;
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
    if (archive.reads()) set_mean_free_time(mean_free_time);
  }

 private:
  void set_mean_free_time(double mean_free_time) {
    mean_free_time_ = mean_free_time;
    span_ = std::isfinite(mean_free_time) ? std::ldexp(1.0, std::ilogb(mean_free_time))
                                          : mean_free_time;
  }

  Time end_;
  double mean_free_time_ = 0, span_ = 0;
  std::uint64_t quiet_ = 0, collisions_ = 0;  ///< windows since the last collision; collisions then
};

}  // namespace needlework
