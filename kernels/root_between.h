// The root of a function that is monotone between two times.
#pragma once

#include <cmath>

namespace needlework::kernels {

/// What no double lies between: the time before the root, or that past it.
enum class RootSide { before, past };

/// Newton's iteration from the middle of the interval, halving it where that leaves it.
/// `value(s)` returns f and df / ds, `is_past(f)` whether s is past the root. The result is a time
/// at which f is 0, or one that the iteration no longer changes but by rounding; where no double is
/// left between both ends, that on `side`.
template <class Value, class IsPast>
double root_between(double low, double high, RootSide side, const Value& value,
                    const IsPast& is_past) {
  double s = low + 0.5 * (high - low);
  for (int n = 0; n < 100; ++n) {
    const auto [f, df] = value(s);
    if (f == 0) return s;
    (is_past(f) ? high : low) = s;
    double next = s - f / df;
    if (!(low < next && next < high)) next = low + 0.5 * (high - low);
    if (!(low < next && next < high)) return side == RootSide::before ? low : high;
    if (std::abs(next - s) <= 0x1p-52 * s) return next;
    s = next;
  }
  return s;
}

}  // namespace needlework::kernels
