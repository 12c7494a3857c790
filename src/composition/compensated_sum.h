// Sums of many numbers.
#pragma once

#include <cmath>

namespace needlework {

/// A sum with a running correction (Neumaier), so that a sum of a million terms loses no digits.
class CompensatedSum {
 public:
  void add(double x) {
    const double total = total_ + x;
    correction_ += std::abs(total_) >= std::abs(x) ? (total_ - total) + x : (x - total) + total_;
    total_ = total;
  }
  double value() const { return total_ + correction_; }

 private:
  double total_ = 0;
  double correction_ = 0;
};

}  // namespace needlework
