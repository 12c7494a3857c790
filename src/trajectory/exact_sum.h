// Sums that do not depend on the order of their terms: each term is rounded to a common
// fixed-point grid, and the integers are added.
#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/power_of_two.h"

namespace needlework {

__extension__ using Int128 = __int128;
__extension__ using UnsignedInt128 = unsigned __int128;

/// A sum of fewer than 2^60 terms, none larger than `largest` in magnitude. The error is below the
/// number of terms times largest 2^-60.
class ExactSum {
 public:
  explicit ExactSum(double largest = 0) : exponent_(largest > 0 ? exponent_of(largest) : 0) {}

  void add(double term) {
    // There are 2^60 grid points per `largest`. Each term is truncated by itself, so the order
    // does not matter.
    total_ += static_cast<std::int64_t>(times_power_of_two(term, 60 - exponent_));
  }
  /// Adds the terms of another sum with the same `largest`.
  void take(const ExactSum& other) { total_ += other.total_; }
  double value() const {
    const bool negative = total_ < 0;
    const UnsignedInt128 magnitude =
        negative ? -static_cast<UnsignedInt128>(total_) : static_cast<UnsignedInt128>(total_);
    const double high = static_cast<double>(static_cast<std::uint64_t>(magnitude >> 64));
    const double low = static_cast<double>(static_cast<std::uint64_t>(magnitude));
    const double sum = times_power_of_two(high, 64) + low;
    return times_power_of_two(negative ? -sum : sum, exponent_ - 60);
  }

 private:
  int exponent_;
  Int128 total_ = 0;
};

}  // namespace needlework
