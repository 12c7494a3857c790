// Rates and ratios of the kinetic theory, against published and independently computed numbers.
#include "needlework/theory.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "needlework/diffusion.h"
#include "src/theory/graded_rule.h"
#include "tests/support/message_of.h"

namespace needlework::theory {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

using Line = boost::math::quadrature::gauss<double, 20>;

/// Mean of f(s12, s21) over the square of arms, by plain tensor quadrature: good for moderate k.
template <class F>
double square_mean(F f) {
  const auto inner = [&](double x) {
    return Line::integrate([&](double y) { return f(x, y); }, 0.0, 0.5);
  };
  return 4.0 * Line::integrate(inner, 0.0, 0.5);
}

/// Both changes of temperature by smooth needles, straight from the published integrals.
Temperatures published_smooth_rates(double k, double epsilon, double q) {
  const auto translation = [&](double x, double y) {
    const double a = k * (x * x + y * y);
    const double g = std::sqrt(1.0 + q * a);
    return g / (1.0 + a) * (-1.0 + 0.5 * (1.0 + epsilon) * (1.0 + q * a) / (1.0 + a));
  };
  const auto rotation = [&](double x, double y) {
    const double a = k * (x * x + y * y);
    const double g = std::sqrt(1.0 + q * a);
    return a * g / (1.0 + a) * (-q + 0.5 * (1.0 + epsilon) * (1.0 + q * a) / (1.0 + a));
  };
  return {.t_tr = 0.5 * (1.0 + epsilon) * square_mean(translation),
          .t_rot = 0.75 * (1.0 + epsilon) * square_mean(rotation)};
}

/// What the impulse in the plane of the needles adds, T_tr = 1, from the matrices of that plane and
/// a third quadrature over the angle between the directors.
Temperatures tangential_rates_by_matrices(double k, double beta, double q) {
  const auto changes = [&](double s12, double s21, double theta) {
    const Eigen::Vector2d across1(0.0, 1.0);  // directors along x and at theta: the normals to them
    const Eigen::Vector2d across2(-std::sin(theta), std::cos(theta));
    const Eigen::Matrix2d arms =
        s12 * s12 * across1 * across1.transpose() + s21 * s21 * across2 * across2.transpose();
    const Eigen::Matrix2d inverse_mass = 2.0 * Eigen::Matrix2d::Identity() + 2.0 * k * arms;
    const Eigen::Matrix2d impulse = -(1.0 + beta) * inverse_mass.inverse();  // of velocity V_t
    const Eigen::Matrix2d translation = 2.0 * Eigen::Matrix2d::Identity();   // <v12 v12>
    const Eigen::Matrix2d rotation = 2.0 * k * q * arms;
    const Eigen::Matrix2d squared = impulse * (translation + rotation) * impulse.transpose();
    return std::pair{(impulse * translation).trace() + squared.trace(),
                     (impulse * rotation).trace() + k * (arms * squared).trace()};
  };
  const auto mean = [&](auto part) {
    return square_mean([&](double s12, double s21) {
      const auto at_angle = [&](double theta) {
        return 4.0 / std::numbers::pi * std::pow(std::sin(theta), 2) *
               part(changes(s12, s21, theta));
      };
      return std::sqrt(1.0 + q * k * (s12 * s12 + s21 * s21)) *
             boost::math::quadrature::gauss<double, 15>::integrate(at_angle, 0.0,
                                                                   0.5 * std::numbers::pi);
    });
  };
  return {.t_tr = 0.25 * mean([](const auto& pair) { return pair.first; }),
          .t_rot = 0.375 * mean([](const auto& pair) { return pair.second; })};
}

TEST(GradedRule, ResolvesAFeatureAtAnyScale) {
  for (const double width : {1.0, 1e-2, 1e-5, 1e-8}) {
    double sum = 0.0;
    for (const auto& [x, weight] : graded_rule(1.0, 1e-10)) {
      sum += weight * width * x / ((width * width + x * x));
    }
    const double exact = 0.5 * width * std::log1p(1.0 / (width * width));
    EXPECT_NEAR(sum, exact, 2e-14 * exact) << "width " << width;
  }
}

TEST(CollisionIntegral, AgreesWithTensorQuadrature) {
  for (const double k : {0.5, 2.0, 6.0}) {
    for (const double q : {0.1, 1.0, 2.0}) {
      const double expected =
          square_mean([&](double x, double y) { return std::sqrt(1.0 + q * k * (x * x + y * y)); });
      EXPECT_NEAR(collision_integral(q, k), expected, 1e-13) << "k " << k << " q " << q;
    }
  }
}

TEST(CollisionIntegral, HasItsLimits) {
  EXPECT_NEAR(collision_integral(0.0, 6.0), 1.0, 1e-14);
  // The mean distance from the centre of a unit square is (sqrt(2) + log(1 + sqrt(2))) / 6.
  const double mean_distance = (std::numbers::sqrt2 + std::log(1.0 + std::numbers::sqrt2)) / 6.0;
  EXPECT_NEAR(collision_integral(1e12, 4.0) / 2e6, mean_distance, 1e-11);
  EXPECT_NEAR(collision_integral(1.0, 1e16) / 1e8, mean_distance, 1e-13);
}

TEST(CollisionRate, HasTheKnownValuesInEquilibrium) {
  EXPECT_NEAR(collision_rate(1.0, {1.0, 1.0}, 6.0), 1.237662397803, 1e-12);
  EXPECT_NEAR(collision_rate(1.0, {1.0, 1.0}, 2.0), 1.020184982, 1e-9);
  EXPECT_NEAR(collision_rate(0.72, {4.0, 4.0}, 6.0), 0.72 * 2.0 * 1.237662397803, 1e-11);
  // The same number counted per unit of tau.
  EXPECT_NEAR(collision_rate(1.0, {1.0, 1.0}, 6.0) / (2.0 / 3.0 * std::sqrt(std::numbers::pi)),
              1.0474143, 1e-7);
}

TEST(CollisionRate, AllowsEitherTemperatureToVanish) {
  EXPECT_NEAR(collision_rate(1.0, {1.0, 0.0}, 6.0), 0.5 * std::sqrt(std::numbers::pi), 1e-14);
  const double mean_distance = (std::numbers::sqrt2 + std::log(1.0 + std::numbers::sqrt2)) / 6.0;
  EXPECT_NEAR(collision_rate(1.0, {0.0, 1.0}, 6.0),
              0.5 * std::sqrt(6.0 * std::numbers::pi) * mean_distance, 1e-14);
  EXPECT_EQ(collision_rate(1.0, {0.0, 0.0}, 6.0), 0.0);
}

TEST(EquilibriumRate, CorrectsForFewNeedles) {
  for (const auto& [count, conserved] :
       {std::pair(2.0, 3), std::pair(6.0, 3), std::pair(24.0, 3), std::pair(6.0, 2)}) {
    const double volume = 30.0;
    const double energy = 2.5 * count;
    const double degrees = 5.0 * count - conserved;
    const double temperature = 2.0 * energy / degrees;
    const double factor =
        std::sqrt(0.5 * degrees) * std::tgamma(0.5 * degrees) / std::tgamma(0.5 * (degrees + 1.0));
    const double expected =
        1.237662397803 * (count - 1.0) / volume * std::sqrt(temperature) * factor;
    EXPECT_NEAR(equilibrium_rate(count, volume, energy, 6.0, conserved), expected, 1e-11 * expected)
        << "count " << count;
  }
  // Without the corrections, 6 needles are off by 11 % and 24 by 3 %.
  const auto correction = [](double count) {
    return equilibrium_rate(count, count, 2.5 * count, 6.0) / 1.237662397803;
  };
  EXPECT_NEAR(correction(6.0), 0.89, 0.005);
  EXPECT_NEAR(correction(24.0), 0.97, 0.005);
}

TEST(EquilibriumRate, TendsToTheLargeGas) {
  for (const double count : {1e4, 1e6, 1e9}) {
    const double ratio = equilibrium_rate(count, count, 2.5 * count, 6.0) / 1.237662397803;
    EXPECT_NEAR(ratio, 1.0, 1.0 / count + 1e-12) << "count " << count;
    EXPECT_LT(ratio, 1.0 + 1e-12);
  }
}

TEST(CoolingRates, AgreeWithThePublishedIntegralsForSmoothNeedles) {
  for (const double k : {2.0, 6.0}) {
    for (const double epsilon : {0.0, 0.5, 0.8, 1.0}) {
      for (const double q : {0.0, 0.3, 1.0, 2.5}) {
        const Temperatures expected = published_smooth_rates(k, epsilon, q);
        const Temperatures rates = cooling_rates({k, epsilon, -1.0}, {1.0, q});
        EXPECT_NEAR(rates.t_tr, expected.t_tr, 1e-13) << k << " " << epsilon << " " << q;
        EXPECT_NEAR(rates.t_rot, expected.t_rot, 1e-13) << k << " " << epsilon << " " << q;
      }
    }
  }
}

TEST(CoolingRates, AgreeWithTheMatricesOfThePlaneForRoughNeedles) {
  struct Case {
    double k, q, beta;
  };
  for (const Case& rough : {Case{6.0, 0.0, -0.5}, Case{6.0, 0.4, 0.0}, Case{2.0, 2.5, 1.0}}) {
    const Temperatures smooth = published_smooth_rates(rough.k, 0.7, rough.q);
    const Temperatures tangential = tangential_rates_by_matrices(rough.k, rough.beta, rough.q);
    const Temperatures rates = cooling_rates({rough.k, 0.7, rough.beta}, {1.0, rough.q});
    EXPECT_NEAR(rates.t_tr, smooth.t_tr + tangential.t_tr, 1e-10) << rough.beta;
    EXPECT_NEAR(rates.t_rot, smooth.t_rot + tangential.t_rot, 1e-10) << rough.beta;
  }
}

TEST(CoolingRates, HaveTheKnownValuesForRoughNeedles) {
  struct Known {
    double epsilon, beta, t_tr, t_rot;
  };
  for (const Known& known :
       {Known{0.8, 0.5, -0.253536, -0.201011}, Known{1.0, 0.0, -0.249866, -0.148908},
        Known{0.9, -0.5, -0.222305, -0.158828}}) {
    const Temperatures rates = cooling_rates({6.0, known.epsilon, known.beta}, {1.0, 1.0});
    EXPECT_NEAR(rates.t_tr, known.t_tr, 6e-7);
    EXPECT_NEAR(rates.t_rot, known.t_rot, 6e-7);
  }
}

TEST(CoolingRates, AreThoseOfBothRestitutions) {
  for (const double k : {0.01, 2.0, 6.0, 1e3, 1e6}) {
    const double collisions = 0.75 * collision_integral(1.0, k);  // per needle and unit of tau
    for (const double epsilon : {0.0, 0.8, 1.0}) {
      for (const double beta : {-1.0, -0.5, 0.0, 0.7, 1.0}) {
        const double loss = -cooling_rates({k, epsilon, beta}, {1.0, 1.0}).energy();
        const double expected =
            0.5 * collisions * ((1.0 - epsilon * epsilon) + (1.0 - beta * beta));
        EXPECT_NEAR(loss, expected, 1e-13 * collisions) << k << " " << epsilon << " " << beta;
      }
    }
  }
}

TEST(CoolingRates, ConserveEnergyWhenElastic) {
  for (const double beta : {-1.0, 1.0}) {
    for (const double k : {0.1, 2.0, 6.0, 1e4}) {
      for (const Temperatures now : {Temperatures{1.0, 0.0}, Temperatures{0.0, 1.0},
                                     Temperatures{1.0, 0.3}, Temperatures{0.2, 5.0}}) {
        const Temperatures rates = cooling_rates({k, 1.0, beta}, now);
        EXPECT_NE(rates.t_tr, 0.0);
        EXPECT_NEAR(rates.energy(), 0.0, 1e-15 * std::abs(rates.t_rot)) << beta << " " << k;
      }
      const Temperatures equal = cooling_rates({k, 1.0, beta}, {2.0, 2.0});
      EXPECT_EQ(equal.t_tr, 0.0);
      EXPECT_EQ(equal.t_rot, 0.0);
    }
  }
}

TEST(CoolingRates, RelaxElasticDifferencesAtTheKnownRate) {
  struct Known {
    double k, rate_per_root_energy;
  };
  for (const Known& known : {Known{6.0, 0.4836}, Known{2.0, 0.3073}}) {
    const double lambda = 2.5 * square_mean([&](double x, double y) {
                            const double a = known.k * (x * x + y * y);
                            return a / std::pow(1.0 + a, 1.5);
                          });
    // At fixed energy, T_tr - T_rot = 5 d.
    const auto slope = [&](double d) {
      const Temperatures rates =
          cooling_rates({known.k, 1.0, -1.0}, {1.0 + 2.0 * d, 1.0 - 3.0 * d});
      return rates.t_tr - rates.t_rot;
    };
    const double d = 1e-5;
    EXPECT_NEAR(-(slope(d) - slope(-d)) / (10.0 * d), lambda, 1e-9);
    EXPECT_NEAR(lambda / std::sqrt(2.5), known.rate_per_root_energy, 5e-5);
  }
}

TEST(CoolingRates, ScaleWithTheTemperature) {
  const Gas gas{6.0, 0.7, 0.2};
  const Temperatures unit = cooling_rates(gas, {1.0, 0.4});
  for (const int power : {-40, 12}) {
    const Temperatures scaled =
        cooling_rates(gas, {std::ldexp(1.0, 2 * power), std::ldexp(0.4, 2 * power)});
    EXPECT_DOUBLE_EQ(scaled.t_tr, std::ldexp(unit.t_tr, 3 * power));
    EXPECT_DOUBLE_EQ(scaled.t_rot, std::ldexp(unit.t_rot, 3 * power));
  }
}

TEST(CoolingRates, AllowEitherTemperatureToVanish) {
  for (const double beta : {-1.0, 0.3, 1.0}) {
    const Gas gas{6.0, 0.8, beta};
    const Temperatures from_rest = cooling_rates(gas, {1.0, 0.0});
    EXPECT_LT(from_rest.t_tr, 0.0);
    EXPECT_GT(from_rest.t_rot, 0.0);
    const Temperatures from_spin = cooling_rates(gas, {0.0, 1.0});
    EXPECT_GT(from_spin.t_tr, 0.0);
    EXPECT_LT(from_spin.t_rot, 0.0);
    // Continuous there.
    EXPECT_NEAR(cooling_rates(gas, {1.0, 1e-12}).t_rot, from_rest.t_rot, 1e-11);
    EXPECT_NEAR(cooling_rates(gas, {1e-12, 1.0}).t_tr, from_spin.t_tr, 1e-11);
    const Temperatures frozen = cooling_rates(gas, {0.0, 0.0});
    EXPECT_EQ(frozen.t_tr, 0.0);
    EXPECT_EQ(frozen.t_rot, 0.0);
  }
}

TEST(AsymptoticRatio, HasTheKnownValues) {
  EXPECT_NEAR(asymptotic_ratio({6.0, 0.8, -1.0}), 1.0377327, 5.1e-8);
  EXPECT_NEAR(asymptotic_ratio({6.0, 0.9, -1.0}), 1.0178038, 5.1e-8);
  EXPECT_NEAR(asymptotic_ratio({2.0, 0.5, -1.0}), 0.7318548, 5.1e-8);
  EXPECT_NEAR(asymptotic_ratio({20.0, 0.1, -1.0}), 3.0902744, 5.1e-8);
}

TEST(AsymptoticRatio, IsKeptByTheRates) {
  for (const Gas& gas : {Gas{6.0, 0.8, -1.0}, Gas{2.0, 1.0, 0.5}, Gas{20.0, 0.3, 1.0},
                         Gas{0.1, 0.0, 0.0}, Gas{1e4, 0.9, -0.2}}) {
    const double c = asymptotic_ratio(gas);
    const Temperatures rates = cooling_rates(gas, {c, 1.0});
    EXPECT_LT(rates.t_tr, 0.0);
    EXPECT_NEAR(rates.t_tr / rates.t_rot, c, 1e-12 * c) << gas.k;
  }
}

TEST(AsymptoticRatio, IsUndefinedOnlyForElasticGases) {
  EXPECT_TRUE(std::isnan(asymptotic_ratio({6.0, 1.0, -1.0})));
  EXPECT_TRUE(std::isnan(asymptotic_ratio({6.0, 1.0, 1.0})));
  EXPECT_TRUE(std::isfinite(asymptotic_ratio({6.0, 1.0, 0.0})));
  EXPECT_NEAR(asymptotic_ratio({6.0, 1.0 - 1e-9, -1.0}), 1.0, 1e-8);
}

TEST(EquipartitionK, HasTheKnownValue) {
  EXPECT_NEAR(equipartition_k(), 4.3607003448823784, 1e-13);
  for (const double epsilon : {0.0, 0.5, 0.99}) {
    EXPECT_NEAR(asymptotic_ratio({equipartition_k(), epsilon, -1.0}), 1.0, 1e-12);
  }
}

TEST(Theory, NamesValueAndExpectationOfBadInput) {
  const auto rates_of = [](Gas gas) { return [gas] { cooling_rates(gas, {1.0, 1.0}); }; };
  EXPECT_EQ(test::message_of<std::invalid_argument>(rates_of({6.0, 1.5, -1.0})),
            "epsilon = 1.5: expected a number in [0, 1]");
  EXPECT_EQ(test::message_of<std::invalid_argument>(rates_of({6.0, 0.8, -1.25})),
            "beta = -1.25: expected a number in [-1, 1]");
  EXPECT_EQ(test::message_of<std::invalid_argument>(rates_of({0.0, 0.8, -1.0})),
            "k = 0: expected a number in [1e-12, 1e12]");
  EXPECT_EQ(test::message_of<std::invalid_argument>([] {
              cooling_rates({}, {-1.0, 1.0});
            }),
            "t_tr = -1: expected a finite number, 0 or more");
  EXPECT_EQ(test::message_of<std::invalid_argument>([] {
              cooling_rates({}, {1.0, -0.5});
            }),
            "t_rot = -0.5: expected a finite number, 0 or more");
}

TEST(Theory, RejectsNumbersOutOfRange) {
  for (const double bad : {0.0, -6.0, nan_value, infinity}) {
    EXPECT_THROW(asymptotic_ratio({bad, 0.8, -1.0}), std::invalid_argument) << bad;
    EXPECT_THROW(collision_integral(1.0, bad), std::invalid_argument) << bad;
    EXPECT_THROW(collision_rate(1.0, {1.0, 1.0}, bad), std::invalid_argument) << bad;
    EXPECT_THROW(equilibrium_rate(10.0, 1.0, 25.0, bad), std::invalid_argument) << bad;
    EXPECT_THROW(equilibrium_rate(10.0, bad, 25.0, 6.0), std::invalid_argument) << bad;
    EXPECT_THROW(equilibrium_rate(bad, 1.0, 25.0, 6.0), std::invalid_argument) << bad;
  }
  for (const double bad : {-0.1, 1.1, nan_value}) {
    EXPECT_THROW(asymptotic_ratio({6.0, bad, -1.0}), std::invalid_argument) << bad;
  }
  for (const double bad : {-1.1, 1.1, nan_value}) {
    EXPECT_THROW(asymptotic_ratio({6.0, 0.8, bad}), std::invalid_argument) << bad;
  }
  for (const double bad : {-0.1, nan_value, infinity}) {
    EXPECT_THROW(collision_integral(bad, 6.0), std::invalid_argument) << bad;
    EXPECT_THROW(collision_rate(bad, {1.0, 1.0}, 6.0), std::invalid_argument) << bad;
    EXPECT_THROW(collision_rate(1.0, {bad, 1.0}, 6.0), std::invalid_argument) << bad;
    EXPECT_THROW(cooling_rates({}, {bad, 1.0}), std::invalid_argument) << bad;
    EXPECT_THROW(cooling_rates({}, {1.0, bad}), std::invalid_argument) << bad;
    EXPECT_THROW(equilibrium_rate(10.0, 1.0, bad, 6.0), std::invalid_argument) << bad;
  }
  EXPECT_THROW(uncorrelated_transport(-1, 1, 6), std::invalid_argument);
  EXPECT_THROW(uncorrelated_transport(1, 0, 6), std::invalid_argument);
  EXPECT_THROW(uncorrelated_transport(1, 1, 0), std::invalid_argument);
  EXPECT_EQ(uncorrelated_transport(0, 1, 6).velocity_decay, 0);
  EXPECT_TRUE(std::isinf(uncorrelated_transport(0, 1, 6).diffusion));
  EXPECT_THROW(equilibrium_rate(1.0, 1.0, 2.5, 6.0), std::invalid_argument);
  EXPECT_THROW(equilibrium_rate(10.0, 1.0, 25.0, 6.0, 4), std::invalid_argument);
}

}  // namespace
}  // namespace needlework::theory
