#include "src/random/portable_math.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace needlework::portable {

namespace {

constexpr DoubleDouble ln2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr std::uint64_t fraction_bits = (std::uint64_t{1} << 52) - 1;
constexpr int bias = 1023;

// 2^n for -1022 <= n <= 1023.
double power_of_two(int n) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(n + bias) << 52);
}

DoubleDouble scaled(const DoubleDouble& x, double power) { return {x.hi * power, x.lo * power}; }

// ln((1 + f) / (1 - f)) = 2 f (1 + f^2 / 3 + f^4 / 5 + ...) for |f| < 0.1716. All but the first
// term is below 1 % of it, so that double is enough for it.
DoubleDouble log_of_ratio(const DoubleDouble& f) {
  const double square = f.hi * f.hi;
  double series = 0;
  for (int n = 23; n >= 3; n -= 2) series = series * square + 1.0 / n;
  return quick_two_sum(2 * f.hi, 2 * f.lo + 2 * f.hi * (square * series));
}

// e^r - 1 for |r| < 0.347: double is enough for the terms from r^3 / 6 on.
DoubleDouble expm1_of_reduced(const DoubleDouble& r) {
  double series = 0;
  for (int n = 15; n >= 3; --n) series = (1 + series) * (r.hi / n);
  return r + scaled(r * r, 0.5) * (DoubleDouble(1) + series);
}

// e^x = 2^n (1 + rest).
struct Split {
  int n;
  DoubleDouble rest;
};

Split split_exp(const DoubleDouble& x) {
  constexpr double to_whole = 0x1.8p52;  // adding it rounds to a whole number
  const double n = (x.hi * (1 / ln2.hi) + to_whole) - to_whole;
  return {static_cast<int>(n), expm1_of_reduced(x - ln2 * n)};
}

}  // namespace

DoubleDouble log(const DoubleDouble& x) {
  // x = 2^exponent m with m in [sqrt(1/2), sqrt(2)).
  const auto bits = std::bit_cast<std::uint64_t>(x.hi);
  int exponent = static_cast<int>(bits >> 52) - bias;
  const double fraction =
      std::bit_cast<double>((bits & fraction_bits) | (std::uint64_t{bias} << 52));
  if (fraction > 1.4142135623730951) ++exponent;
  // In two factors, as 2^-exponent need not be a normal number.
  const int half = exponent / 2;
  const DoubleDouble m = scaled(scaled(x, power_of_two(-half)), power_of_two(half - exponent));
  const DoubleDouble log_m = log_of_ratio((m - 1) / (m + 1));
  return exponent == 0 ? log_m : ln2 * exponent + log_m;
}

DoubleDouble log1p(const DoubleDouble& x) {
  return std::abs(x.hi) < 0.25 ? log_of_ratio(x / (x + 2)) : log(x + 1);
}

DoubleDouble exp(const DoubleDouble& x) {
  if (x.hi < -708) return 0;
  const auto [n, rest] = split_exp(x);
  return scaled(rest + 1, power_of_two(n));
}

DoubleDouble expm1(const DoubleDouble& x) {
  return std::abs(x.hi) < 0.34 ? expm1_of_reduced(x) : exp(x) - 1;
}

}  // namespace needlework::portable
