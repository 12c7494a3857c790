// The times at which a run is sampled.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "src/archive/archive.h"

namespace needlework {

/// Times of samples in increasing order, returned one by one.
class Schedule {
 public:
  /// A schedule without times.
  Schedule() = default;

  /// The times 10^(n / per_decade) for all integers n, from the first one that is >= `start`. They
  /// do not depend on `start` otherwise, so that runs with different seeds are sampled at the same
  /// times. Without times if `start` is not finite and positive.
  static Schedule logarithmic(double per_decade, double start);

  /// The times n `step` for n = 1, 2, ...; `step` must be finite and positive.
  static Schedule linear(double step);

  /// The given times, which must increase.
  static Schedule at(std::vector<double> times);

  /// The next time [time], or infinity if there is none.
  double next() const { return next_; }

  /// Whether it has had no times from the start.
  bool is_empty() const { return per_decade_ == 0 && step_ == 0 && times_.empty(); }

  /// Removes all times up to and including `time`.
  void pass(double time);

  /// Saves or restores how far the schedule has come.
  friend void transfer(Archive& archive, Schedule& schedule) {
    archive(schedule.per_decade_, schedule.step_, schedule.n_, schedule.times_, schedule.position_,
            schedule.next_);
    archive.require(schedule.next_ == schedule.time_of_next() && std::abs(schedule.n_) < 0x1p52);
  }
  /// Whether its times are those of `whole`, or none, and the next one is at `time` or later.
  bool is_rest_of(const Schedule& whole, double time) const {
    const bool same =
        per_decade_ == whole.per_decade_ && step_ == whole.step_ && times_ == whole.times_;
    return (is_empty() || same) && next_ >= time;
  }

 private:
  double grid_time(double n) const;
  double time_of_next() const;

  double per_decade_ = 0;  ///< > 0: logarithmic
  double step_ = 0;        ///< > 0: linear; neither: a list of times
  double n_ = 0;           ///< index of the next time of a grid; a double, because it can be any
                           ///< size
  std::vector<double> times_;
  std::size_t position_ = 0;
  double next_ = std::numeric_limits<double>::infinity();
};

}  // namespace needlework
