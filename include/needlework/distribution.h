// Distributions of sizes: what the lengths, diameters or masses of bodies are drawn from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace needlework {

/// A distribution of positive numbers, of one shape, cut off at its ends. The mean and the width,
/// standard deviation over mean, are those of the whole distribution, before its ends cut it.
///
/// | shape | numbers x, z standard normal | needs | width, or 0: the mean itself |
/// |---|---|---|---|
/// | uniform | equally likely within mean (1 ± √3 width) | mean, width | 1e-6 to 0.57735 |
/// | normal | mean (1 + width z) | mean, width, least | 1e-6 to 0.5 |
/// | lognormal | mean e^(s z) / √(1 + width²), s² = ln(1 + width²) | mean, width | 1e-6 to 1 |
/// | gamma | density ∝ x^(a-1) e^(-a x / mean), a = 1 / width² | mean, width | 1e-3 to 1 |
/// | powerlaw | density ∝ x^-exponent | least, greatest, exponent | |
struct Distribution {
  enum class Shape { uniform, normal, lognormal, gamma, powerlaw };
  /// Names of the shapes in their order.
  static constexpr std::array shape_names{"uniform", "normal", "lognormal", "gamma", "powerlaw"};

  Shape shape = Shape::uniform;
  std::optional<double> mean = {};      ///< > 0, not of a power law
  std::optional<double> width = {};     ///< [1], not of a power law
  std::optional<double> least = {};     ///< > 0: no smaller numbers, "min" in scenes
  std::optional<double> greatest = {};  ///< > 0: no greater numbers, "max" in scenes
  std::optional<double> exponent = {};  ///< from -20 to 20, of a power law alone [1]

  friend bool operator==(const Distribution&, const Distribution&) = default;
};

inline const char* name_of(Distribution::Shape shape) {
  return Distribution::shape_names[static_cast<std::size_t>(shape)];
}

/// A parameter of a distribution that cannot be used.
struct WrongParameter {
  const char* name;             ///< "mean", "width", "min", "max" or "exponent"
  std::optional<double> value;  ///< none: it is missing
  const char* expected;         ///< what it has to be, as in "expected a number > 0"
};

/// The first parameter that cannot be used, or none. Among others, the ends have to keep a
/// thousandth of the whole distribution.
std::optional<WrongParameter> what_is_wrong(const Distribution& distribution);

/// The inverse of the distribution function, ready to be evaluated many times; of a distribution
/// with which nothing is wrong. Threads may share it. Copies share what they know.
class Quantiles {
 public:
  explicit Quantiles(const Distribution& distribution);

  /// The number with the probability (top53 + 1/2) / 2^53 below it, top53 < 2^53, within the ends;
  /// it grows with top53, but for rounding. Its bits are the same on every machine, its relative
  /// error is at most 5e-15 (normal distributions: 5e-15 of the mean).
  double operator()(std::uint64_t top53) const;

  /// The mean of x^p within the ends, -0.9 <= p <= 4, with a relative error of some 1e-12. Machines
  /// may differ in its last bits.
  double moment(double p) const;

  /// The share of the whole distribution that lies within the ends.
  double share() const { return share_; }

  class Law;

 private:
  std::shared_ptr<const Law> law_;
  double least_, greatest_;
  double below_, above_;  ///< probabilities of smaller and of greater numbers that the ends cut off
  double share_;
};

}  // namespace needlework
