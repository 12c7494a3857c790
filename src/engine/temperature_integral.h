// The integral of the translational temperature over time, for means since the start of a run.
#pragma once

#include <cmath>

#include "src/physics/clock.h"

namespace needlework {

/// From the temperatures at the ends of windows, so that it costs nothing between them and depends
/// on the simulated history only.
class TemperatureIntegral {
 public:
  /// Notes the temperature now; where it jumps, first that before and then that after.
  void note(const Clock& clock, Time now, double temperature) {
    sum_ = at(clock, now, temperature);
    noted_at_ = now;
    temperature_ = temperature;
  }
  /// Up to now, where the temperature is this. [energy time]
  double at(const Clock& clock, Time now, double temperature) const {
    return sum_ + clock.difference(now, noted_at_) * mean(temperature_, temperature);
  }

  template <class A>
  void transfer(A& archive) {
    archive(noted_at_, sum_, temperature_);
  }
  bool is_sound() const {
    return std::isfinite(sum_) && sum_ >= 0 && std::isfinite(temperature_) && temperature_ >= 0;
  }

 private:
  // Exact for Haff's law, by which 1 / sqrt(T) of a cooling gas grows evenly, and for even heating.
  static double mean(double first, double last) {
    return last < first ? std::sqrt(first) * std::sqrt(last) : 0.5 * (first + last);
  }

  Time noted_at_;
  double sum_ = 0;          ///< up to then
  double temperature_ = 0;  ///< from then on
};

}  // namespace needlework
