#include "src/effects/driving/growing.h"

#include <algorithm>

namespace needlework {

void Growing::measure(const Clock& clock, Time now, const Sums& sums, double bodies) {
  // The rate of collisions changes by about as much as the temperature in one step.
  constexpr double most_change = 8;
  const double counted = static_cast<double>(sums.collisions - then_.collisions);
  const double wanted = parameters_.collisions;
  if (is_looking() && counted * most_change < wanted) {
    step_ *= most_change;
    next_ = clock.add({}, step_);
    return;
  }
  step_ *= std::clamp(wanted / std::max(counted, 0.5), 1 / most_change, most_change);
  next_ = clock.add(now, step_);
  then_ = sums;
  if (static_cast<double>(sums.collisions - measured_.collisions) < std::min(wanted, bodies))
    return;
  const double integral = sums.integral - measured_.integral;
  if (integral > 0) pressure_ = 1 + (sums.virial - measured_.virial) / (3 * bodies * integral);
  measured_ = sums;
}

}  // namespace needlework
