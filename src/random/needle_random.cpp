#include "src/random/needle_random.h"

#include <Random123/philox.h>

#include <bit>
#include <cmath>

namespace needlework {

double natural_log(double x) {
  // x = 2^exponent m with m in [sqrt(1/2), sqrt(2)). ln m = 2 artanh f with f = (m - 1) / (m + 1)
  // and |f| < 0.1716, so that the truncated series is accurate to 1e-18 of its first term.
  constexpr std::uint64_t fraction_bits = (std::uint64_t{1} << 52) - 1;
  constexpr std::uint64_t exponent_of_one = std::uint64_t{1023} << 52;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  double exponent = static_cast<double>(static_cast<int>(bits >> 52) - 1023);
  double m = std::bit_cast<double>((bits & fraction_bits) | exponent_of_one);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    exponent += 1;
  }
  const double f = (m - 1) / (m + 1);
  const double square = f * f;
  double series = 0;
  for (int n = 23; n >= 3; n -= 2) series = series * square + 1.0 / n;
  // ln 2 in two parts; the first has so few bits that its product with the exponent is exact.
  constexpr double ln2_high = 0x1.62e42feep-1;
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  return exponent * ln2_high + (2 * f + (2 * f * square * series + exponent * ln2_low));
}

std::uint64_t NeedleRandom::bits() {
  if (used_ == words_.size()) {
    const auto words = r123::Philox4x64()({{block_++, id_, count_, purpose_}}, {{seed_, 0}});
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] = words[i];
    used_ = 0;
  }
  return words_[used_++] >> 11;
}

NeedleRandom::DiscPoint NeedleRandom::disc_point() {
  while (true) {
    const double x = 2 * uniform() - 1;
    const double y = 2 * uniform() - 1;
    const double squared = x * x + y * y;
    if (squared < 1 && squared > 0) return {x, y, squared};
  }
}

std::array<double, 3> NeedleRandom::direction() {
  const DiscPoint p = disc_point();
  const double scale = 2 * std::sqrt(1 - p.squared);
  const std::array<double, 3> u{p.x * scale, p.y * scale, 1 - 2 * p.squared};
  const double length = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  return {u[0] / length, u[1] / length, u[2] / length};
}

std::array<double, 2> NeedleRandom::normal_pair() {
  const DiscPoint p = disc_point();
  const double scale = std::sqrt(-2 * natural_log(p.squared) / p.squared);
  return {p.x * scale, p.y * scale};
}

std::array<double, 3> NeedleRandom::normal() {
  const auto [x, y] = normal_pair();
  return {x, y, normal_pair()[0]};
}

}  // namespace needlework
