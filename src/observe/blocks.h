// Rates with honest errors: counts in blocks of time.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace needlework {

/// Counts events in blocks of equal length and takes the error of their rate from the spread
/// between blocks, which includes the correlation of events within one (a tenth and more of all
/// collisions repeat the pair of the one before). The number of blocks stays between 32 and 64,
/// once there are as many, by joining neighbours, so nothing needs to be known of the run's length.
class BlockRate {
 public:
  static constexpr int most_blocks = 64;
  static constexpr int fewest_blocks = 8;  ///< for an error

  struct Estimate {
    double rate = std::numeric_limits<double>::quiet_NaN();            ///< [1 / time]
    double standard_error = std::numeric_limits<double>::quiet_NaN();  ///< NaN: too few blocks
    int blocks = 0;
  };

  /// Blocks begin with this length [time], finite and > 0; it should be at least the time over
  /// which events are correlated.
  explicit BlockRate(double block_length);

  /// Counts an event. Times must not decrease, and are >= 0.
  void add(double time);

  /// The rate over the blocks that are complete at this time, not before the last event.
  Estimate estimate(double now) const;

 private:
  double length_;
  std::vector<std::uint64_t> counts_;  ///< of the blocks so far, the last one unfinished
};

}  // namespace needlework
