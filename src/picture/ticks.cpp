#include "src/picture/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace needlework::picture {
namespace {

// Differences and squares of numbers up to here do not overflow.
constexpr double largest = 1e150;
// Ticks of a range that is narrower than this, relative to its place, could not be told apart.
constexpr double narrowest = 1e-12;

double power_of_ten(int exponent) { return std::pow(10.0, exponent); }

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(value) + 1e-9)); }

// The least of 1, 2, 5, 10, ... that divides a length into at most `count` steps.
double step_of(double length, int count) {
  const double least = length / count * (1 - 1e-9);
  const double decade = power_of_ten(exponent_of(least));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least) return factor * decade;
  }
  return 10 * decade;
}

// With the sign that typesetters use for a minus.
std::string with_minus(const std::string& number) {
  std::string text;
  for (const char c : number) text += c == '-' ? "−" : std::string(1, c);
  return text;
}

// With the digits that stand above the line.
std::string power_text(int exponent) {
  constexpr std::array digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : fmt::to_string(std::abs(exponent))) {
    text += digits[static_cast<std::size_t>(c - '0')];
  }
  return text;
}

std::string with_power(double factor, int decimals, int exponent) {
  if (decimals == 0 && factor == 1) return power_text(exponent);
  return fmt::format("{:.{}f}·{}", factor, decimals, power_text(exponent));
}

std::vector<Tick> linear_ticks(Range range, int count) {
  const double step = step_of(range.high - range.low, count);
  const double greatest = std::max(std::abs(range.low), std::abs(range.high));
  const int least_digit = exponent_of(step), first_digit = exponent_of(greatest);
  const bool plain = first_digit < 5 && least_digit > -4;
  const int decimals = plain ? std::max(0, -least_digit) : first_digit - least_digit;
  std::vector<Tick> all;
  const double tolerance = 1e-6;  // of a step: rounding must not lose the ends
  const double last = std::floor(range.high / step + tolerance);
  for (double n = std::ceil(range.low / step - tolerance); n <= last; ++n) {
    if (n == 0) {
      all.push_back({0, "0"});
    } else {
      const std::string label =
          plain ? fmt::format("{:.{}f}", n * step, decimals)
                : with_power(n * step / power_of_ten(first_digit), decimals, first_digit);
      all.push_back({n * step, with_minus(label)});
    }
  }
  return all;
}

std::string label_of(double factor, int exponent, bool plain) {
  if (plain || exponent == 0) {
    return fmt::format("{:.{}f}", factor * power_of_ten(exponent), std::max(0, -exponent));
  }
  return with_minus(with_power(factor, 0, exponent));
}

std::vector<Tick> logarithmic_ticks(Range range, int count) {
  const double decades = std::log10(range.high) - std::log10(range.low);
  if (decades < 0.7) return linear_ticks(range, count);
  const int first = static_cast<int>(std::floor(std::log10(range.low)));
  const int last = static_cast<int>(std::ceil(std::log10(range.high)));
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / count)));
  const bool plain = first >= -3 && last <= 4;
  std::vector<Tick> all;
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % stride != 0) continue;
    for (const int factor : {1, 2, 5}) {
      // With few decades in sight, decades alone say too little.
      if (factor > 1 && decades >= 2) continue;
      const double value = factor * power_of_ten(exponent);
      if (value < range.low * (1 - 1e-9) || value > range.high * (1 + 1e-9)) continue;
      all.push_back({value, label_of(factor, exponent, plain)});
    }
  }
  return all;
}

}  // namespace

bool can_be_placed(double value, bool logarithmic) {
  return std::isfinite(value) && (!logarithmic || value > 0);
}

Range usable_range(Range range, bool logarithmic) {
  if (!can_be_placed(range.low, logarithmic) || !can_be_placed(range.high, logarithmic)) {
    return logarithmic ? Range{1, 10} : Range{0, 1};
  }
  if (range.low > range.high) std::swap(range.low, range.high);
  if (logarithmic) {
    range.low = std::clamp(range.low, 1 / largest, largest);
    range.high = std::clamp(range.high, 1 / largest, largest);
    if (range.high <= range.low * (1 + narrowest)) return {range.low / 2, range.high * 2};
    return range;
  }
  range.low = std::clamp(range.low, -largest, largest);
  range.high = std::clamp(range.high, -largest, largest);
  const double greatest = std::max(std::abs(range.low), std::abs(range.high));
  if (greatest < 1 / largest) return {-1, 1};
  if (range.high - range.low > narrowest * greatest) return range;
  return {range.low - greatest / 2, range.high + greatest / 2};
}

void RangeOfValues::add(double value) {
  if (!can_be_placed(value, logarithmic_)) return;
  range_.low = empty_ ? value : std::min(range_.low, value);
  range_.high = empty_ ? value : std::max(range_.high, value);
  empty_ = false;
}

void RangeOfValues::add(const std::vector<double>& values) {
  for (const double value : values) add(value);
}

Range RangeOfValues::range(double margin) const {
  if (empty_) return logarithmic_ ? Range{1, 10} : Range{0, 1};
  const Range all = usable_range(range_, logarithmic_);
  if (logarithmic_) {
    const double factor = std::pow(all.high / all.low, margin);
    return usable_range({all.low / factor, all.high * factor}, true);
  }
  const double beyond = margin * (all.high - all.low);
  return usable_range({all.low - beyond, all.high + beyond}, false);
}

std::vector<Tick> ticks(Range range, bool logarithmic, int count) {
  return logarithmic ? logarithmic_ticks(range, count) : linear_ticks(range, count);
}

double Scale::operator()(double value) const {
  if (!can_be_placed(value, logarithmic)) return std::numeric_limits<double>::quiet_NaN();
  const auto place = [&](double x) { return logarithmic ? std::log10(x) : x; };
  const double share = (place(value) - place(range.low)) / (place(range.high) - place(range.low));
  // Far beyond the picture the place is no longer exact, so that pixels stay finite.
  return begin + std::clamp(share, -1e4, 1e4) * (end - begin);
}

}  // namespace needlework::picture
