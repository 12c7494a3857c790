// The cooling curve, against known points, its own equations, and the laws it must obey.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "needlework/theory.h"

namespace needlework::theory {
namespace {

Temperatures point(const Gas& gas, Temperatures initial, double tau) {
  return cooling_curve(gas, initial, std::vector{tau}).front();
}

double collisions(const Gas& gas, Temperatures initial, double tau) {
  return collisions_per_needle(gas, initial, std::vector{tau}).front();
}

constexpr Gas dilute_gas{6.0, 0.8, -1.0};
constexpr Temperatures no_rotation{1.0, 0.0};

TEST(CoolingCurve, PassesThroughTheKnownPoints) {
  struct Known {
    double tau, energy, ratio;
  };
  const double c = 1.0377327;
  for (const Known& known : {Known{1.0, 1.4260991, 4.0603325}, Known{10.0, 0.9149328, 1.0632908},
                             Known{100.0, 0.09871055, c}, Known{1e3, 1.658014e-3, c},
                             Known{1e4, 1.760713e-5, c}, Known{1e6, 1.772590e-9, c}}) {
    const Temperatures now = point(dilute_gas, no_rotation, known.tau);
    EXPECT_NEAR(now.energy(), known.energy, 5e-7 * known.energy) << "tau " << known.tau;
    EXPECT_NEAR(now.t_tr / now.t_rot, known.ratio, 6e-8) << "tau " << known.tau;
  }
}

TEST(CoolingCurve, LosesElevenDecadesInTheKnownTimeAndCollisions) {
  const double tau = 1.087e7;  // rounded to 4 digits; the energy falls with the square
  EXPECT_NEAR(point(dilute_gas, no_rotation, tau).energy() / 1.5, 1e-11, 1e-14);
  EXPECT_NEAR(collisions(dilute_gas, no_rotation, tau), 352.9, 0.05);
}

TEST(CoolingCurve, SolvesTheRateEquations) {
  for (const Gas& gas :
       {dilute_gas, Gas{2.0, 0.5, 0.3}, Gas{20.0, 1.0, 1.0}, Gas{6.0, 0.0, -1.0}}) {
    for (const double tau : {0.3, 3.0, 30.0, 300.0, 3e4}) {
      const double h = 1e-4 * tau;
      const std::vector<double> taus = {tau - 2 * h, tau - h, tau, tau + h, tau + 2 * h};
      const auto curve = cooling_curve(gas, {1.0, 0.1}, taus);
      const auto counts = collisions_per_needle(gas, {1.0, 0.1}, taus);
      const auto slope = [&](auto value) {
        return (8.0 * (value(3) - value(1)) - (value(4) - value(0))) / (12.0 * h);
      };
      const Temperatures rates = cooling_rates(gas, curve[2]);
      const double scale = curve[2].energy() / tau + std::abs(rates.energy());
      SCOPED_TRACE(testing::Message()
                   << "k " << gas.k << " epsilon " << gas.epsilon << " tau " << tau);
      EXPECT_NEAR(slope([&](int i) { return curve[i].t_tr; }), rates.t_tr, 1e-7 * scale);
      EXPECT_NEAR(slope([&](int i) { return curve[i].t_rot; }), rates.t_rot, 1e-7 * scale);
      const double rate = 0.75 * std::sqrt(curve[2].t_tr) *
                          collision_integral(curve[2].t_rot / curve[2].t_tr, gas.k);
      EXPECT_NEAR(slope([&](int i) { return counts[i]; }), rate, 1e-7 * (rate + counts[2] / tau));
    }
  }
}

TEST(CoolingCurve, GoesOnFromAnyOfItsPoints) {
  for (const Gas& gas : {dilute_gas, Gas{20.0, 0.2, 0.5}, Gas{6.0, 1.0, -1.0}}) {
    const Temperatures end = point(gas, no_rotation, 5e3);
    const double end_collisions = collisions(gas, no_rotation, 5e3);
    for (const double stop : {1e-3, 1.0, 7.0, 80.0, 2e3}) {
      const Temperatures halfway = point(gas, no_rotation, stop);
      const Temperatures again = point(gas, halfway, 5e3 - stop);
      EXPECT_NEAR(again.t_tr, end.t_tr, 1e-11 * end.t_tr) << "stop " << stop;
      EXPECT_NEAR(again.t_rot, end.t_rot, 1e-11 * end.t_rot) << "stop " << stop;
      EXPECT_NEAR(collisions(gas, no_rotation, stop) + collisions(gas, halfway, 5e3 - stop),
                  end_collisions, 1e-11 * end_collisions);
    }
  }
}

TEST(CoolingCurve, ScalesWithTheInitialTemperature) {
  const Temperatures unit = point(dilute_gas, {1.0, 0.5}, 40.0);
  const Temperatures hot = point(dilute_gas, {1e8, 0.5e8}, 40.0e-4);
  EXPECT_NEAR(hot.t_tr, 1e8 * unit.t_tr, 1e-3 * unit.t_tr);
  EXPECT_NEAR(hot.t_rot, 1e8 * unit.t_rot, 1e-3 * unit.t_rot);
}

TEST(CoolingCurve, TakesTimesInAnyOrder) {
  const std::vector<double> taus = {1e8, 0.0, 10.0, 1e-9, 10.0, 1.0};
  const auto curve = cooling_curve(dilute_gas, no_rotation, taus);
  ASSERT_EQ(curve.size(), taus.size());
  EXPECT_EQ(curve[1].t_tr, 1.0);
  EXPECT_EQ(curve[1].t_rot, 0.0);
  EXPECT_EQ(curve[2].t_tr, curve[4].t_tr);
  EXPECT_NEAR(curve[2].energy(), 0.9149328, 5e-8);
  EXPECT_NEAR(curve[5].energy(), 1.4260991, 5e-8);
  EXPECT_NEAR(curve[0].energy(), 1.772709e-13, 1e-18);
  const Temperatures start = cooling_rates(dilute_gas, no_rotation);
  EXPECT_NEAR(curve[3].t_rot, 1e-9 * start.t_rot, 1e-14);
  EXPECT_TRUE(cooling_curve(dilute_gas, no_rotation, std::vector<double>{}).empty());
}

TEST(CoolingCurve, StartsFromRotationAlone) {
  const std::vector<double> taus = {1e-6, 1.0, 100.0, 1e8};
  const auto curve = cooling_curve(dilute_gas, {0.0, 1.0}, taus);
  const Temperatures start = cooling_rates(dilute_gas, {0.0, 1.0});
  EXPECT_NEAR(curve[0].t_tr, 1e-6 * start.t_tr, 1e-5 * 1e-6 * start.t_tr);
  for (const Temperatures& now : curve) {
    EXPECT_GT(now.t_tr, 0.0);
    EXPECT_GT(now.t_rot, 0.0);
  }
  EXPECT_NEAR(curve[3].t_tr / curve[3].t_rot, asymptotic_ratio(dilute_gas), 1e-11);
}

TEST(CoolingCurve, EndsAtTheAsymptoticRatioInHaffsLaw) {
  for (const Gas& gas : {Gas{6.0, 0.999, -1.0}, Gas{2.0, 0.1, -1.0}, Gas{6.0, 1.0, 0.2},
                         Gas{100.0, 0.5, 1.0}, Gas{0.5, 0.9, -0.9}}) {
    const auto curve = cooling_curve(gas, no_rotation, std::vector<double>{1e9, 1e12});
    EXPECT_NEAR(curve[0].t_tr / curve[0].t_rot, asymptotic_ratio(gas), 1e-9) << gas.k;
    EXPECT_NEAR(curve[0].energy() / curve[1].energy() / 1e6, 1.0, 2e-5) << gas.k;
  }
}

TEST(CoolingCurve, KeepsTheEnergyOfAnElasticGas) {
  for (const double beta : {-1.0, 1.0}) {
    const Gas gas{6.0, 1.0, beta};
    for (const double tau : {0.1, 1.0, 10.0, 1e3, 1e8}) {
      EXPECT_NEAR(point(gas, no_rotation, tau).energy(), 1.5, 1e-14) << tau;
    }
    const Temperatures end = point(gas, no_rotation, 1e8);
    EXPECT_NEAR(end.t_tr, 0.6, 1e-12);
    EXPECT_NEAR(end.t_rot, 0.6, 1e-12);
  }
}

TEST(CoolingCurve, IsAtRestWithoutEnergy) {
  EXPECT_EQ(point(dilute_gas, {0.0, 0.0}, 10.0).energy(), 0.0);
  EXPECT_EQ(collisions(dilute_gas, {0.0, 0.0}, 10.0), 0.0);
}

TEST(CoolingCurve, RejectsBadInput) {
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {-1.0, nan_value, infinity}) {
    EXPECT_THROW(point(dilute_gas, no_rotation, bad), std::invalid_argument) << bad;
    EXPECT_THROW(collisions(dilute_gas, no_rotation, bad), std::invalid_argument) << bad;
    EXPECT_THROW(point(dilute_gas, {bad, 1.0}, 1.0), std::invalid_argument) << bad;
    EXPECT_THROW(point(dilute_gas, {1.0, bad}, 1.0), std::invalid_argument) << bad;
  }
  EXPECT_THROW(point({6.0, 1.2, -1.0}, no_rotation, 1.0), std::invalid_argument);
  try {
    point(dilute_gas, no_rotation, -2.0);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()), "tau = -2: expected a finite number, 0 or more");
  }
}

}  // namespace
}  // namespace needlework::theory
