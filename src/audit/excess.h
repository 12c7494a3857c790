// Differences of reported numbers from those of a rule, in units of what rounding may explain.
#pragma once

#include <cmath>

#include "src/audit/ball.h"

namespace needlework::audit {

/// The largest difference so far; infinite after one that is not a number.
class Excess {
 public:
  void add(double deviation, double explained) {
    const double excess = deviation == 0 ? 0 : deviation / explained;
    most_ = excess <= most_ ? most_ : std::isnan(excess) ? HUGE_VAL : excess;
  }
  void add(const Quad& deviation, double explained) { add(magnitude(deviation), explained); }
  double most() const { return most_; }

 private:
  double most_ = 0;
};

}  // namespace needlework::audit
