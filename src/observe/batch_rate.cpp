#include "src/observe/batch_rate.h"

#include <algorithm>
#include <cmath>

namespace needlework {

BatchRate::BatchRate(double batch_length) : length_(batch_length) { counts_.reserve(most_batches); }

void BatchRate::add(double time) {
  while (time >= length_ * most_batches) {
    const std::size_t joined = (counts_.size() + 1) / 2;
    counts_.resize(2 * joined, 0);
    for (std::size_t b = 0; b < joined; ++b) counts_[b] = counts_[2 * b] + counts_[2 * b + 1];
    counts_.resize(joined);
    length_ *= 2;
  }
  const auto batch = static_cast<std::size_t>(time / length_);
  if (counts_.size() <= batch) counts_.resize(batch + 1, 0);
  ++counts_[batch];
}

BatchRate::Estimate BatchRate::estimate(double now) const {
  Estimate estimate;
  // After a long time without events there are more batches than have counts.
  const double complete = std::floor(now / length_);
  if (!(complete >= 1)) return estimate;
  const auto counted = std::min(static_cast<std::size_t>(std::min(complete, 1e9)), counts_.size());
  double sum = 0;
  for (std::size_t b = 0; b < counted; ++b) sum += static_cast<double>(counts_[b]);
  const double mean = sum / complete;
  double squares = (complete - static_cast<double>(counted)) * mean * mean;
  for (std::size_t b = 0; b < counted; ++b) {
    const double difference = static_cast<double>(counts_[b]) - mean;
    squares += difference * difference;
  }
  estimate.batches = static_cast<int>(std::min(complete, 1e9));
  estimate.rate = mean / length_;
  if (complete >= fewest_batches) {
    estimate.standard_error = std::sqrt(squares / (complete - 1) / complete) / length_;
  }
  return estimate;
}

}  // namespace needlework
