// Random numbers that are the same on every machine and with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/support/real.h"
#include "tests/support/vector.h"

namespace needlework::test {

/// splitmix64 (Steele, Lea, Flood 2014). Only IEEE arithmetic and correctly rounded functions are
/// used on top of it; the logarithm is taken in enough digits to round it.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// In (0, 1), never an end.
  double uniform() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool coin() { return bits() >> 63; }
  int below(int count) { return static_cast<int>(uniform() * count); }

  /// Logarithm uniform between those of the two ends.
  double log_uniform(double low, double high) {
    const Quad a = log(Quad(low)), b = log(Quad(high));
    return static_cast<double>(exp(Quad(a + (b - a) * uniform())));
  }

  /// Normal, variance 1 (Marsaglia's polar method).
  double normal() {
    for (;;) {
      const double x = uniform(-1, 1), y = uniform(-1, 1), s = x * x + y * y;
      if (s < 1 && s > 0) return x * std::sqrt(-2 * logarithm(s) / s);
    }
  }

  /// Exponential, mean 1.
  double exponential() { return -logarithm(uniform()); }

  Vec<double> normal_vector(double sigma) {
    const double x = normal(), y = normal(), z = normal();
    return {sigma * x, sigma * y, sigma * z};
  }

  /// Uniform on the unit sphere.
  Vec<double> direction() {
    for (;;) {
      const Vec<double> v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      const double s = dot(v, v);
      if (s < 1 && s > 0.01) return (1 / std::sqrt(s)) * v;
    }
  }

 private:
  static double logarithm(double x) {
    // 64 bits determine the rounding to 53 in all but a few of a thousand cases.
    using Extended = long double;
    if constexpr (std::numeric_limits<Extended>::digits == 64) {
      const Extended value = std::log(Extended(x)), error = 0x1p-61L * std::abs(value);
      const auto low = static_cast<double>(value - error);
      if (low == static_cast<double>(value + error)) return low;
    }
    return static_cast<double>(log(Quad(x)));
  }

  std::uint64_t state_;
};

}  // namespace needlework::test
