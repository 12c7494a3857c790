// Counts of values in bins of equal width.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "src/archive/archive.h"

namespace needlework::observe {

/// Bins of equal width from `low` to `high`. A value at a border belongs to the bin above it, and
/// `high` itself to the last bin. Values outside, and NaN, are not counted.
class Histogram {
 public:
  Histogram(double low, double high, std::size_t bins)
      : low_(low), high_(high), counts_(bins, 0.0) {}

  void add(double value) {
    if (!(value >= low_ && value <= high_)) return;
    const double bins = static_cast<double>(counts_.size());
    const auto bin = static_cast<std::size_t>((value - low_) / (high_ - low_) * bins);
    ++counts_[bin < counts_.size() ? bin : counts_.size() - 1];
  }

  /// The number of values in each bin; doubles, as are all rows of observables.
  const std::vector<double>& counts() const { return counts_; }
  void transfer(Archive& archive) {
    const std::size_t bins = counts_.size();
    archive(counts_);
    archive.require(counts_.size() == bins);
  }
  void clear() { counts_.assign(counts_.size(), 0.0); }

  /// The borders of the bins, one more than there are bins.
  std::vector<double> borders() const {
    std::vector<double> out;
    const double bins = static_cast<double>(counts_.size());
    for (std::size_t n = 0; n <= counts_.size(); ++n) {
      out.push_back(std::lerp(low_, high_, static_cast<double>(n) / bins));
    }
    return out;
  }

 private:
  double low_, high_;
  std::vector<double> counts_;
};

}  // namespace needlework::observe
