#include "src/random/probability.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/random/portable_math.h"

namespace needlework {

Probability Probability::of_bits(std::uint64_t j) {
  constexpr std::uint64_t all = std::uint64_t{1} << 54;
  const std::uint64_t odd = 2 * j + 1;
  const double smaller = static_cast<double>(std::min(odd, all - odd)) * 0x1p-54;
  return odd < all / 2 ? Probability{smaller, 1 - smaller} : Probability{1 - smaller, smaller};
}

namespace {

using Coefficients = std::array<double, 8>;

// A quotient of two polynomials, coefficients from the highest power down.
double quotient(const Coefficients& above, const Coefficients& below, double r) {
  double a = 0, b = 0;
  for (const double c : above) a = a * r + c;
  for (const double c : below) b = b * r + c;
  return a / b;
}

// What Stirling's formula of ln Gamma(a) leaves out: ln Gamma(a) = (a - 1/2) ln a - a + ln(2 pi)/2
// + this. From a + 1 to a it grows by (a + 1/2) ln(1 + 1/a) - 1.
DoubleDouble stirling_rest(double a) {
  DoubleDouble out = 0;
  for (; a < 16; a += 1)
    out = out + (DoubleDouble(a) + 0.5) * portable::log1p(1 / DoubleDouble(a)) - 1;
  const double x = 1 / (a * a);
  const double series =
      ((((((x / 156 - 691.0 / 360360) * x + 1.0 / 1188) * x - 1.0 / 1680) * x + 1.0 / 1260) * x -
        1.0 / 360) *
       x);
  return out + 1 / (DoubleDouble(a) * 12) + series / a;
}

// Continued fractions for the derivatives of ln P(a, x) and -ln Q(a, x) by ln x (Legendre), from
// their ends. `excess` is x - a; the numbers of terms leave out less than 1e-16 where excess <= 0
// or excess >= 0, and were found in quadruple precision for a from 0.5 to 1e6.
double lower_fraction(double x, double excess, double cube_root) {
  double out = 0;
  for (int n = 12 + static_cast<int>(15 * cube_root); n > 0; --n) out = n * x / (n - excess + out);
  return out - excess;
}
double upper_fraction(double a, double excess, double cube_root) {
  double out = 0;
  for (int n = static_cast<int>(110 / (a + excess) + 10 * cube_root); n > 0; --n)
    out = n * (a - n) / (excess + (2 * n + 1) + out);
  return excess + 1 + out;
}

}  // namespace

double normal_quantile(const Probability& u) {
  constexpr Coefficients centre_above{
      2509.0809287301226727, 33430.575583588128105, 67265.770927008700853, 45921.953931549871457,
      13731.693765509461125, 1971.5909503065514427, 133.14166789178437745, 3.387132872796366608};
  constexpr Coefficients centre_below{
      5226.495278852545925,  28729.085735721942674, 39307.89580009271061,  21213.794301586595867,
      5394.1960214247511077, 687.1870074920579083,  42.313330701600911252, 1.0};
  constexpr Coefficients tail_above{7.7454501427834140764e-4, 0.0227238449892691845833,
                                    0.24178072517745061177,   1.27045825245236838258,
                                    3.64784832476320460504,   5.7694972214606914055,
                                    4.6303378461565452959,    1.42343711074968357734};
  constexpr Coefficients tail_below{1.05075007164441684324e-9, 5.475938084995344946e-4,
                                    0.0151986665636164571966,  0.14810397642748007459,
                                    0.68976733498510000455,    1.6763848301838038494,
                                    2.05319162663775882187,    1.0};
  constexpr Coefficients far_above{2.01033439929228813265e-7, 2.71155556874348757815e-5,
                                   0.0012426609473880784386,  0.026532189526576123093,
                                   0.29656057182850489123,    1.7848265399172913358,
                                   5.4637849111641143699,     6.6579046435011037772};
  constexpr Coefficients far_below{2.04426310338993978564e-15, 1.4215117583164458887e-7,
                                   1.8463183175100546818e-5,   7.868691311456132591e-4,
                                   0.0148753612908506148525,   0.13692988092273580531,
                                   0.59983220655588793769,     1.0};
  const double p = u.smaller();
  const double q = 0.5 - p;
  double size;
  if (q <= 0.425) {
    size = q * quotient(centre_above, centre_below, 0.180625 - q * q);
  } else {
    const double r = std::sqrt(-to_double(portable::log(p)));
    size =
        r <= 5 ? quotient(tail_above, tail_below, r - 1.6) : quotient(far_above, far_below, r - 5);
  }
  return u.is_lower() ? -size : size;
}

Probability normal_probability(double z) {
  // z^2 has the gamma distribution of shape 1/2.
  static const GammaLaw squares(0.5);
  constexpr double beyond = 40;
  const double bounded = std::min(std::abs(z), beyond);
  const double tail = squares.probability(two_prod(bounded, bounded)).above / 2;
  return z < 0 ? Probability{tail, 1 - tail} : Probability{1 - tail, tail};
}

GammaLaw::GammaLaw(double shape) : shape_(shape), root_(0) {
  while (root_ * root_ * root_ < shape) root_ += 1;
  constexpr DoubleDouble two_pi{0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52};
  log_norm_ = portable::log(DoubleDouble(shape) / two_pi) * 0.5 - stirling_rest(shape);
}

GammaLaw::Tail GammaLaw::nearer_tail(const DoubleDouble& x) const {
  const DoubleDouble beyond_mean = x - 1;
  const double excess = shape_ * to_double(beyond_mean);
  const double slope = x.hi < 1 ? lower_fraction(shape_ * x.hi, excess, root_)
                                : upper_fraction(shape_, excess, root_);
  // The density of ln x, over the slope.
  const DoubleDouble log_density = log_norm_ - (beyond_mean - portable::log(x)) * shape_;
  return {log_density - portable::log(slope), slope};
}

GammaLaw::Tail GammaLaw::Tail::other() const {
  const double share = to_double(portable::exp(log));
  return {portable::log1p(-share), slope * share / (1 - share)};
}

Probability GammaLaw::probability(const DoubleDouble& x) const {
  if (!(x.hi > 1e-300)) return {0, 1};
  if (x.hi > 1e10) return {1, 0};
  const double tail = to_double(portable::exp(nearer_tail(x).log));
  return x.hi < 1 ? Probability{tail, 1 - tail} : Probability{1 - tail, tail};
}

double GammaLaw::quantile(const Probability& u) const {
  // Start: the cube root is nearly normal (E. B. Wilson and M. M. Hilferty, PNAS 17, 684 (1931)),
  // but for small values. ln P and ln Q are concave functions of ln x, and nearly linear in the
  // tails, so that Halley's method in ln x converges from anywhere.
  const bool lower = u.is_lower();
  const DoubleDouble wanted = portable::log(u.smaller());
  const double width = 1 / std::sqrt(shape_);
  const double root = std::max(0.2, 1 - width * width / 9 + width * normal_quantile(u) / 3);
  double x = root * root * root;
  constexpr int most_steps = 50;
  for (int n = 0; n < most_steps; ++n) {
    const Tail nearer = nearer_tail(x);
    const Tail tail = lower == (x < 1) ? nearer : nearer.other();
    const double slope = lower ? tail.slope : -tail.slope;
    const double newton = to_double(tail.log - wanted) / slope;
    const double bend = shape_ * (1 - x) - slope;  // second derivative over the first
    const double step = newton / std::max(0.5, 1 - newton * bend / 2);
    x = to_double(portable::exp(-step) * x);
    // The error is now of the third power of the step.
    if (std::abs(step) < 1e-6 * width) break;
  }
  return x;
}

double GammaLaw::moment(double p) const {
  // Gamma(shape + p) / (Gamma(shape) shape^p).
  return to_double(
      portable::exp((DoubleDouble(shape_) + (p - 0.5)) * portable::log1p(DoubleDouble(p) / shape_) -
                    p + stirling_rest(shape_ + p) - stirling_rest(shape_)));
}

}  // namespace needlework
