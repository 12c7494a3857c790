// Interval arithmetic: a number known to lie between two doubles. Every operation rounds outwards,
// by more than the half unit in the last place that it may be off, without a change of the
// processor's rounding mode.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/double_double.h"
#include "kernels/sine_cosine.h"

namespace needlework {

/// All numbers from lo to hi, lo <= hi.
struct Range {
  double lo = 0, hi = 0;
  constexpr Range() = default;
  constexpr Range(double value) : lo(value), hi(value) {}  // NOLINT: a double is a range
  constexpr Range(double low, double high) : lo(low), hi(high) {}

  bool has_zero() const { return !(lo > 0 || hi < 0); }
  /// The largest and the least magnitude in it.
  double most() const { return std::max(std::abs(lo), std::abs(hi)); }
  double least() const { return has_zero() ? 0 : std::min(std::abs(lo), std::abs(hi)); }
};

/// What is surely not above, or below, a result of one rounding.
inline double round_down(double x) {
  return x - (std::abs(x) * 0x1p-52 + std::numeric_limits<double>::denorm_min());
}
inline double round_up(double x) {
  return x + (std::abs(x) * 0x1p-52 + std::numeric_limits<double>::denorm_min());
}

inline Range operator-(const Range& a) { return {-a.hi, -a.lo}; }
inline Range operator+(const Range& a, const Range& b) {
  return {round_down(a.lo + b.lo), round_up(a.hi + b.hi)};
}
inline Range operator-(const Range& a, const Range& b) { return a + (-b); }
inline Range operator*(const Range& a, const Range& b) {
  const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  return {round_down(std::min({p, q, r, s})), round_up(std::max({p, q, r, s}))};
}

/// The numbers in both; they must have some in common.
inline Range common(const Range& a, const Range& b) {
  return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

/// The largest magnitude: what error bounds need.
inline double to_double(const Range& a) { return a.most(); }

/// Encloses a double-double that is itself off by up to `error`.
inline Range range_of(const DoubleDouble& a, double error) {
  const double off = round_up(std::abs(a.lo) + error);
  return {round_down(a.hi - off), round_up(a.hi + off)};
}

/// Sine and cosine of |x| <= 2^40.
inline SineCosine<Range> sine_cosine(const Range& x) {
  const double off = 0x1p-52 * std::max(1.0, x.most());
  const auto sine_range = [&](double low, double high) {
    return Range{std::max(low - off, -1.0), std::min(high + off, 1.0)};
  };
  const SineCosine<double> begin = sine_cosine(x.lo);
  if (x.lo == x.hi) {
    return {sine_range(begin.sine, begin.sine), sine_range(begin.cosine, begin.cosine)};
  }
  if (!(x.hi - x.lo < 3)) return {{-1, 1}, {-1, 1}};
  const SineCosine<double> end = sine_cosine(x.hi);
  // Over less than 3 there is one extremum at most, 1 or -1, where the slope changes its sign; and
  // then the nearer end has a value of that sign.
  const auto over = [&](double a, double b, double slope_a, double slope_b) {
    Range out = sine_range(std::min(a, b), std::max(a, b));
    if (slope_a >= -off && slope_b <= off && out.hi > 0) out.hi = 1;
    if (slope_a <= off && slope_b >= -off && out.lo < 0) out.lo = -1;
    return out;
  };
  return {over(begin.sine, end.sine, begin.cosine, end.cosine),
          over(begin.cosine, end.cosine, -begin.sine, -end.sine)};
}

}  // namespace needlework
