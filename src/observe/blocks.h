// Rates with error estimates that include correlations: events are counted in blocks of time.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace needlework {

/// Counts events in blocks of equal length. The error of their rate is estimated from the spread
/// between blocks, which includes correlations within a block (a tenth or more of all collisions
/// repeat the pair of the previous one). Once there are 64 blocks, neighbours are joined, so that
/// there are always 32 to 64 and the length of the run need not be known.
class BlockRate {
 public:
  static constexpr int most_blocks = 64;
  static constexpr int fewest_blocks = 8;  ///< for an error estimate

  struct Estimate {
    double rate = std::numeric_limits<double>::quiet_NaN();  ///< [1 / time]
    double standard_error =
        std::numeric_limits<double>::quiet_NaN();  ///< NaN if there are too few blocks
    int blocks = 0;
  };

  /// `block_length` [time] is that of the first blocks. It must be finite and > 0, and should be
  /// at least the time over which events are correlated.
  explicit BlockRate(double block_length);

  /// Counts an event. Times must be >= 0 and must not decrease.
  void add(double time);

  /// The rate over all blocks that are complete at time `now`, which must not be before the last
  /// event.
  Estimate estimate(double now) const;

 private:
  double length_;
  std::vector<std::uint64_t> counts_;  ///< of all blocks, the unfinished last one included
};

}  // namespace needlework
