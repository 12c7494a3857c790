// Rough spheres: the exchange of energy between flight and spin, equipartition, and the state in
// which they cool.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "needlework/simulation.h"
#include "needlework/theory.h"
#include "tests/support/rods.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::agrees;
using test::Mean;
using test::rods_of;

Scene rough(std::uint64_t count, double packing, const Restitution& rule, std::uint64_t seed) {
  Scene scene = rods_of(count, 0, packing, seed);
  scene.collisions.epsilon = rule.epsilon;
  scene.collisions.beta = rule.beta;
  return scene;
}

// Law: for Gaussian velocities at the start d T / dt per collision of a sphere is exactly
// -(4/3) (A T_tr - B T_rot) and (4/3) (B T_tr - C T_rot); for epsilon = beta = 1 and q = 2/5 the
// difference falls by (8/3) q / (1 + q)^2 = 0.5442 of it. Of first collisions of pairs, in a time
// in which few spheres collide twice.
void expect_exact_exchange(const Restitution& rule, double t_rot, int runs, double errors) {
  Mean flight, spin;
  const double eta = 0.5 * (1 + rule.beta) * 0.4 / 1.4,
               a = (1 - rule.epsilon * rule.epsilon) / 4 + eta * (1 - eta), b = eta * eta / 0.4,
               c = eta / 0.4 * (1 - eta / 0.4);
  for (int run = 0; run < runs; ++run) {
    Scene scene = rough(2000, 0.01, rule, 900 + static_cast<std::uint64_t>(run));
    scene.species[0].t_rot = t_rot;
    Simulation gas(scene);
    const Totals before = gas.totals();
    EXPECT_NEAR(before.t_rot, t_rot, 1e-12);
    EXPECT_NEAR(before.energy, 1.5 * (1 + t_rot), 1e-12);
    gas.advance(test::until_collisions(0.04));
    const Totals now = gas.totals();
    const double each = 2 * static_cast<double>(now.collisions) / 2000;
    flight.add((now.t_tr - before.t_tr) / each);
    spin.add((now.t_rot - before.t_rot) / each);
  }
  const double unit = 4.0 / 3;
  EXPECT_TRUE(agrees(flight.measured(), -unit * (a - b * t_rot), errors));
  EXPECT_TRUE(agrees(spin.measured(), unit * (b - c * t_rot), errors));
  if (rule.epsilon == 1 && rule.beta == 1) {
    EXPECT_NEAR(2 * unit * b, 0.5442, 5e-5);
  }
}

TEST(RoughSpheres, ExchangeEnergyAtTheExactRateAtFirst) {
  expect_exact_exchange({1, 1}, 0, 30, 4);
  expect_exact_exchange({0.7, 0.3}, 2, 30, 4);
}

TEST(RoughSpheres, ExchangeEnergyAtTheExactRateAtFirst_long) {
  expect_exact_exchange({1, 1}, 0, 400, 4);
  expect_exact_exchange({0.8, -0.5}, 3, 400, 4);
}

// Theory has the same rates, those of a mixture among them.
TEST(RoughSpheres, HaveTheRatesOfTheory) {
  Composition one({{.count = 1000, .length = 0, .diameter = 1, .q = 0.4}}, {0.7, 0.3});
  const theory::Temperatures now[] = {{.t_tr = 1, .t_rot = 2}};
  const auto rates = theory::mixture_rates(one, 1e5, now);
  const double each = 2 * rates.collisions[0] / 1000, eta = 0.65 * 0.4 / 1.4;
  EXPECT_NEAR(rates.temperatures[0].t_tr / each,
              -4.0 / 3 * (0.51 / 4 + eta * (1 - eta) - eta * eta / 0.4 * 2), 1e-9);
  EXPECT_NEAR(rates.temperatures[0].t_rot / each,
              4.0 / 3 * (eta * eta / 0.4 - eta / 0.4 * (1 - eta / 0.4) * 2), 1e-9);
  // Of unequal spheres, without loss, all energy stays.
  Composition two({{.count = 100, .length = 0, .diameter = 1, .q = 0.4},
                   {.count = 50, .length = 0, .mass = 3, .diameter = 2, .q = 0.6}},
                  {1, 1});
  const theory::Temperatures both[] = {{.t_tr = 1, .t_rot = 0.5}, {.t_tr = 2, .t_rot = 3}};
  const auto of_two = theory::mixture_rates(two, 1e4, both);
  const auto power = [&](int n) {
    return 1.5 * (of_two.temperatures[n].t_tr + of_two.temperatures[n].t_rot);
  };
  EXPECT_NEAR(100 * power(0) + 50 * power(1), 0, 1e-9 * 100 * std::abs(power(0)));
}

// The mean field of the cooling state, which diverges as beta tends to -1, as spins are left.
TEST(RoughSpheres, HaveTheMeanFieldOfTheCoolingState) {
  const auto ratio = [](double epsilon, double beta) {
    return 1 / theory::asymptotic_ratio_of_spheres(0.4, {epsilon, beta});
  };
  EXPECT_NEAR(ratio(0.9, 0.5), 0.8671, 5e-5);
  EXPECT_NEAR(ratio(0.9, -0.9), 53.22, 5e-3);
  EXPECT_NEAR(ratio(0.7, -0.5), 3.949, 5e-4);
  EXPECT_NEAR(ratio(0.7, 1), 1.360, 5e-4);
  EXPECT_TRUE(std::isnan(ratio(1, 1)));
  EXPECT_TRUE(std::isnan(ratio(0.9, -1)));
}

// Elastic, perfectly rough: T_tr over 3 N - 3 degrees of freedom is T_rot over 3 N.
void expect_equipartition(std::uint64_t count, double packing, int runs, double collisions) {
  Mean ratio;
  for (int run = 0; run < runs; ++run) {
    Scene scene = rough(count, packing, {1, 1}, 70 + static_cast<std::uint64_t>(run));
    scene.species[0].t_rot = 0.2;
    Simulation gas(scene);
    const double energy = gas.totals().energy;
    gas.advance(test::until_collisions(30));
    const int samples = 20;
    double t_tr = 0, t_rot = 0;
    for (int n = 1; n <= samples; ++n) {
      gas.advance(test::until_collisions(30 + n * collisions / samples));
      const Totals now = gas.totals();
      t_tr += now.t_tr;
      t_rot += now.t_rot;
      EXPECT_NEAR(now.energy, energy, 1e-11 * energy);
    }
    const double n = static_cast<double>(count);
    ratio.add(t_tr * n / (n - 1) / t_rot);
  }
  EXPECT_TRUE(agrees(ratio.measured(), 1, 4));
  EXPECT_LT(ratio.measured().error, 0.02);
}

TEST(RoughSpheres, HaveOneTemperatureInEquilibrium) { expect_equipartition(50, 0.05, 8, 60); }
TEST(RoughSpheres, HaveOneTemperatureInEquilibrium_long) { expect_equipartition(20, 0.3, 40, 400); }

// Against direct simulation of the Boltzmann equation: T_rot / T_tr within 2 % in a dilute gas.
struct Cooling {
  Restitution rule;
  double ratio, after, until;  ///< collisions of a sphere
};

void expect_cooling_state(const Cooling& of, std::uint64_t count, int runs) {
  Mean ratio;
  for (int run = 0; run < runs; ++run) {
    Scene scene = rough(count, 0.005, of.rule, 40 + static_cast<std::uint64_t>(run));
    scene.species[0].t_rot = of.ratio;
    Simulation gas(scene);
    gas.advance(test::until_collisions(of.after));
    const int samples = 40;
    double sum = 0;
    for (int n = 1; n <= samples; ++n) {
      gas.advance(test::until_collisions(of.after + n * (of.until - of.after) / samples));
      sum += gas.totals().t_rot / gas.totals().t_tr / samples;
    }
    ratio.add(sum);
  }
  const test::Measured found = ratio.measured();
  EXPECT_NEAR(found.value, of.ratio, 0.02 * of.ratio)
      << "epsilon " << of.rule.epsilon << ", beta " << of.rule.beta << ": " << found;
}

TEST(RoughSpheres, CoolInTheStateOfTheBoltzmannEquation_long) {
  expect_cooling_state({{0.9, 0.5}, 0.8520, 15, 45}, 4000, 4);
  expect_cooling_state({{0.7, 0.5}, 1.1991, 10, 25}, 4000, 4);
  expect_cooling_state({{0.7, -0.25}, 1.419, 15, 30}, 4000, 4);
}

}  // namespace
}  // namespace needlework
