// Rates with error estimates that include correlations, by the method of batch means.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "src/archive/archive.h"

namespace needlework {

/// Counts events in batches, stretches of time of equal length. The error of their rate is
/// estimated from the spread between batches, which includes correlations within a batch (a tenth
/// or more of all collisions repeat the pair of the previous one). Once there are 64 batches,
/// neighbours are joined, so that there are always 32 to 64 and the length of the run need not be
/// known.
class BatchRate {
 public:
  static constexpr int most_batches = 64;
  static constexpr int fewest_batches = 8;  ///< for an error estimate

  struct Estimate {
    double rate = std::numeric_limits<double>::quiet_NaN();  ///< [1 / time]
    double standard_error =
        std::numeric_limits<double>::quiet_NaN();  ///< NaN if there are too few batches
    int batches = 0;
  };

  /// `batch_length` [time] is that of the first batches. It must be finite and > 0, and should be
  /// at least the time over which events are correlated.
  explicit BatchRate(double batch_length);

  /// Counts an event. Events may come in any order. Times must be >= 0.
  void add(double time);

  /// The rate over all batches that are complete at time `now`, which must not be before the last
  /// event.
  Estimate estimate(double now) const;

  /// Saves or restores all counts.
  void transfer(Archive& archive) {
    archive(length_, counts_);
    archive.require(std::isfinite(length_) && length_ > 0 && counts_.size() <= most_batches);
  }

 private:
  double length_;
  std::vector<std::uint64_t> counts_;  ///< of all batches, the unfinished last one included
};

}  // namespace needlework
