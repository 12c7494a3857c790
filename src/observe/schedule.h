// When to sample a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace needlework {

/// Times of samples in increasing order, taken one by one.
class Schedule {
 public:
  /// No times at all.
  Schedule() = default;

  /// The times 10^(n / per_decade) for all whole n, from the first that is >= `start` on. The grid
  /// does not depend on `start`, so runs of different seeds are sampled at the same times. No times
  /// if `start` is not finite and positive.
  static Schedule logarithmic(double per_decade, double start);

  /// These times, which must increase.
  static Schedule at(std::vector<double> times);

  /// The next time [time]; infinity when there is none left.
  double next() const { return next_; }

  /// Drops all times up to and including `time`.
  void pass(double time);

 private:
  double grid_time(double n) const;

  double per_decade_ = 0;  ///< 0: the times of the list
  double n_ = 0;           ///< of the next time of the grid; a double, as it can be any size
  std::vector<double> times_;
  std::size_t position_ = 0;
  double next_ = std::numeric_limits<double>::infinity();
};

}  // namespace needlework
