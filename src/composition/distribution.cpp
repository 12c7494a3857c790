#include "needlework/distribution.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "src/random/portable_math.h"
#include "src/random/probability.h"

namespace needlework {

/// A whole distribution.
class Quantiles::Law {
 public:
  Law(double the_least, double the_greatest) : least(the_least), greatest(the_greatest) {}
  virtual ~Law() = default;

  const double least, greatest;  ///< it has no other numbers

  virtual Probability probability(double x) const = 0;
  virtual double quantile(const Probability& u) const = 0;
  /// The integral of x^p over the distribution between these.
  virtual double partial_moment(double p, double from, double to) const = 0;
};

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A distribution of width 0.
class OneNumber : public Quantiles::Law {
 public:
  explicit OneNumber(double number) : Law(number, number) {}
  Probability probability(double x) const override {
    return x < least ? Probability{0, 1} : Probability{1, 0};
  }
  double quantile(const Probability&) const override { return least; }
  double partial_moment(double p, double, double) const override { return std::pow(least, p); }
};

// Probabilities are quotients of integrals of x^-exponent from the end from which these add up
// without cancellation: the least number for exponents up to 1, the greatest for others.
class PowerLaw : public Quantiles::Law {
 public:
  PowerLaw(double exponent, double the_least, double the_greatest)
      : Law(the_least, the_greatest),
        exponent_(exponent),
        rate_(std::abs(exponent - 1)),
        whole_(integral(log_ratio(least, greatest))) {}

  Probability probability(double x) const override {
    const bool up = exponent_ <= 1;
    const double share =
        to_double(integral(up ? log_ratio(least, x) : log_ratio(x, greatest)) / whole_);
    return up ? Probability{share, 1 - share} : Probability{1 - share, share};
  }

  double quantile(const Probability& u) const override {
    const bool up = exponent_ <= 1;
    const DoubleDouble area = whole_ * (up ? u.below : u.above);
    const DoubleDouble y = rate_ > 0 ? portable::log1p(area * rate_) / rate_ : area;
    return to_double(up ? portable::exp(y) * least : portable::exp(-y) * greatest);
  }

  double partial_moment(double p, double from, double to) const override {
    const auto power_integral = [](double q, double y) {
      return q == 0 ? y : std::expm1(q * y) / q;
    };
    const double share_times_power = std::pow(from / least, 1 - exponent_) *
                                     power_integral(p + 1 - exponent_, std::log(to / from)) /
                                     power_integral(1 - exponent_, std::log(greatest / least));
    return std::pow(from, p) * share_times_power;
  }

 private:
  static DoubleDouble log_ratio(double from, double to) {
    return portable::log(DoubleDouble(to) / from);
  }
  // Of e^(rate_ t) for t from 0 to y.
  DoubleDouble integral(const DoubleDouble& y) const {
    return rate_ > 0 ? portable::expm1(y * rate_) / rate_ : y;
  }

  double exponent_, rate_;
  DoubleDouble whole_;
};

class NormalLaw : public Quantiles::Law {
 public:
  NormalLaw(double mean, double width) : Law(0, infinity), mean_(mean), width_(width) {}

  Probability probability(double x) const override { return normal_probability(z_of(x)); }
  double quantile(const Probability& u) const override {
    return mean_ * (1 + width_ * normal_quantile(u));
  }
  double partial_moment(double p, double from, double to) const override {
    constexpr double beyond = 40;  // there, the density is 0
    const auto term = [&](double z) {
      return std::pow(1 + width_ * z, p) * std::exp(-0.5 * z * z) *
             (0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2);
    };
    return std::pow(mean_, p) *
           boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
               term, std::max(z_of(from), -beyond), std::min(z_of(to), beyond), 15, 1e-14);
  }

 private:
  double z_of(double x) const { return (x - mean_) / (mean_ * width_); }

  double mean_, width_;
};

class LognormalLaw : public Quantiles::Law {
 public:
  LognormalLaw(double mean, double width)
      : Law(0, infinity),
        mean_(mean),
        factor_(1 + width * width),
        median_(DoubleDouble(mean) / sqrt(two_prod(width, width) + 1)),
        s_(to_double(sqrt(portable::log1p(two_prod(width, width))))) {}

  Probability probability(double x) const override { return normal_probability(z_of(x)); }
  double quantile(const Probability& u) const override {
    return to_double(portable::exp(two_prod(s_, normal_quantile(u))) * median_);
  }
  double partial_moment(double p, double from, double to) const override {
    const auto shifted = [&](double x) { return normal_probability(z_of(x) - p * s_); };
    return std::pow(mean_, p) * std::pow(factor_, p * (p - 1) / 2) *
           between(shifted(from), shifted(to));
  }

 private:
  double z_of(double x) const {
    if (!(x > 0 && x < infinity)) return x > 0 ? infinity : -infinity;
    return to_double(portable::log(DoubleDouble(x) / median_)) / s_;
  }

  double mean_, factor_;  ///< factor_: mean of x^2 over mean_^2
  DoubleDouble median_;
  double s_;
};

class ScaledGammaLaw : public Quantiles::Law {
 public:
  ScaledGammaLaw(double mean, double width)
      : Law(0, infinity), mean_(mean), shape_(1 / (width * width)), gamma_(shape_) {}

  Probability probability(double x) const override {
    return gamma_.probability(DoubleDouble(x) / mean_);
  }
  double quantile(const Probability& u) const override { return mean_ * gamma_.quantile(u); }
  double partial_moment(double p, double from, double to) const override {
    const GammaLaw higher(shape_ + p);
    const double scale = shape_ / (shape_ + p) / mean_;
    return std::pow(mean_, p) * gamma_.moment(p) *
           between(higher.probability(from * scale), higher.probability(to * scale));
  }

 private:
  double mean_, shape_;
  GammaLaw gamma_;
};

std::shared_ptr<const Quantiles::Law> make_law(const Distribution& d) {
  using enum Distribution::Shape;
  if (d.shape == powerlaw) return std::make_shared<PowerLaw>(*d.exponent, *d.least, *d.greatest);
  const double mean = *d.mean, width = *d.width;
  if (width == 0) return std::make_shared<OneNumber>(mean);
  if (d.shape == normal) return std::make_shared<NormalLaw>(mean, width);
  if (d.shape == lognormal) return std::make_shared<LognormalLaw>(mean, width);
  if (d.shape == gamma) return std::make_shared<ScaledGammaLaw>(mean, width);
  const double reach = std::sqrt(3.0) * width;
  return std::make_shared<PowerLaw>(0, mean * (1 - reach), mean * (1 + reach));
}

}  // namespace

Quantiles::Quantiles(const Distribution& distribution)
    : law_(make_law(distribution)),
      least_(std::max(distribution.least.value_or(0), law_->least)),
      greatest_(std::min(distribution.greatest.value_or(infinity), law_->greatest)) {
  const Probability from = least_ > law_->least ? law_->probability(least_) : Probability{0, 1};
  const Probability to =
      greatest_ < law_->greatest ? law_->probability(greatest_) : Probability{1, 0};
  below_ = from.below;
  above_ = to.above;
  share_ = between(from, to);
}

double Quantiles::operator()(std::uint64_t top53) const {
  const Probability u = Probability::of_bits(top53);
  const double x = law_->quantile({below_ + u.below * share_, above_ + u.above * share_});
  return std::clamp(x, least_, greatest_);
}

double Quantiles::moment(double p) const {
  return law_->partial_moment(p, least_, greatest_) / share_;
}

namespace {

using Shape = Distribution::Shape;
using Wrong = std::optional<WrongParameter>;

constexpr const char* positive = "a number > 0 (from 1e-100 to 1e100)";

struct WidthRange {
  double least, greatest;
  const char* expected;
};

WidthRange width_range(Shape shape) {
  switch (shape) {
    case Shape::uniform:
      return {1e-6, 0.57735, "0, or from 1e-6 to 0.57735 (below 1/sqrt(3), for numbers > 0)"};
    case Shape::normal:
      return {1e-6, 0.5, "0, or from 1e-6 to 0.5"};
    case Shape::gamma:
      return {1e-3, 1, "0, or from 1e-3 to 1"};
    default:
      return {1e-6, 1, "0, or from 1e-6 to 1"};
  }
}

bool holds(const std::optional<double>& value, double least, double greatest) {
  return value && *value >= least && *value <= greatest;  // false for NaN
}

Wrong wrong_size(const char* name, const std::optional<double>& size, bool needed,
                 const char* expected) {
  if ((size || needed) && !holds(size, 1e-100, 1e100)) return WrongParameter{name, size, expected};
  return {};
}

Wrong wrong_among_own(const Distribution& d) {
  if (d.shape == Shape::powerlaw) {
    if (d.mean) return WrongParameter{"mean", d.mean, "none, as a power law has min and max"};
    if (d.width) return WrongParameter{"width", d.width, "none, as a power law has min and max"};
    if (!holds(d.exponent, -20, 20)) {
      return WrongParameter{"exponent", d.exponent, "a number from -20 to 20"};
    }
    return {};
  }
  if (d.exponent) return WrongParameter{"exponent", d.exponent, "none but for a power law"};
  if (const Wrong wrong = wrong_size("mean", d.mean, true, positive)) return wrong;
  const WidthRange range = width_range(d.shape);
  if (d.width != 0 && !holds(d.width, range.least, range.greatest)) {
    return WrongParameter{"width", d.width, range.expected};
  }
  return {};
}

}  // namespace

Wrong what_is_wrong(const Distribution& d) {
  if (const Wrong wrong = wrong_among_own(d)) return wrong;
  const bool is_power_law = d.shape == Shape::powerlaw;
  const bool is_normal = d.shape == Shape::normal && d.width != 0;
  const Wrong least = wrong_size(
      "min", d.least, is_power_law || is_normal,
      is_normal ? "a number > 0 (from 1e-100 to 1e100), as a normal distribution has others"
                : positive);
  if (least) return least;
  if (const Wrong wrong = wrong_size("max", d.greatest, is_power_law, positive)) return wrong;
  if (d.least && d.greatest && !(*d.greatest > *d.least)) {
    return WrongParameter{"max", d.greatest, "a number > min"};
  }
  if (is_power_law) {
    if (!(*d.greatest / *d.least <= 1e12)) {
      return WrongParameter{"max", d.greatest, "at most 1e12 times min"};
    }
    return {};
  }
  constexpr const char* enough = "an end that keeps a thousandth of the distribution";
  if (!(Quantiles(d).share() >= 1e-3)) {
    const bool above = d.least && (*d.least > *d.mean || !d.greatest);
    return above ? WrongParameter{"min", d.least, enough}
                 : WrongParameter{"max", d.greatest, enough};
  }
  return {};
}

}  // namespace needlework
