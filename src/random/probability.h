// Distribution functions and their inverses with the same bits on every machine, accurate in both
// tails.
#pragma once

#include <cstdint>

#include "kernels/double_double.h"

namespace needlework {

/// The probability below a value and that above it, which add up to 1. The smaller of the two has
/// all its digits.
struct Probability {
  double below = 0, above = 1;

  /// (j + 1/2) / 2^53 below: never 0 or 1, exact in the smaller part.
  static Probability of_bits(std::uint64_t j);
  bool is_lower() const { return below <= 0.5; }
  double smaller() const { return is_lower() ? below : above; }
};

/// The probability between two values, the first of which is the smaller one.
inline double between(const Probability& from, const Probability& to) {
  return from.is_lower() ? to.below - from.below : from.above - to.above;
}

/// The standard normal distribution: the probability of values below and above z, infinite or not,
/// the smaller with a relative error below 1e-15; and the value of a probability, with one below
/// 8e-16 (AS241 of M. J. Wichura, Appl. Stat. 37, 477 (1988)).
Probability normal_probability(double z);
double normal_quantile(const Probability& u);

/// The gamma distribution of mean 1 and variance 1/shape, density ∝ x^(shape-1) e^(-shape x), for
/// shapes from 0.1 to 2e6. [1]
class GammaLaw {
 public:
  explicit GammaLaw(double shape);

  /// The regularised incomplete gamma functions P(shape, shape x) and Q = 1 - P; x may be infinite.
  /// P for x < 1 and Q for x >= 1 have a relative error below 1e-15.
  Probability probability(const DoubleDouble& x) const;
  /// The value of a probability, for shapes from 1, with a relative error below 5e-16. Takes 2 to 4
  /// sums of some 10 shape^(1/3) quotients.
  double quantile(const Probability& u) const;
  /// The mean of x^p, p > -shape.
  double moment(double p) const;

 private:
  /// The logarithm of P or Q, and the size of its derivative by ln x.
  struct Tail {
    DoubleDouble log;
    double slope;
    Tail other() const;  ///< of the other of the two
  };
  Tail nearer_tail(const DoubleDouble& x) const;  ///< P for x < 1, Q for others

  double shape_;
  double root_;            ///< cube root of the shape, rounded up
  DoubleDouble log_norm_;  ///< logarithm of the density at x = 1
};

}  // namespace needlework
