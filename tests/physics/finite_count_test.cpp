// Exact results for equilibrium hold for a few needles, with their finite-N terms.
//
// Laws, for the microcanonical ensemble with momentum 0 along p axes (3 N - p translational and 2 N
// rotational degrees of freedom): the rate is theory::equilibrium_rate, and T_tr / T_rot is 1 - p /
// (3 N). In a periodic box p is 3; between walls along one axis it is 2, and the rate is multiplied
// by theory::pair_factor_between_walls. With a heat bath, thermal walls or the thermostat,
// velocities are those of Maxwell at its temperature: the rate is that of N - 1 needles, and p is
// 0. Tolerance: 3 standard errors, from the scatter of batches, each more than 100 mean free times
// long. The values for infinitely many needles must be far outside, so that the test is sensitive
// to these terms.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>

#include "needlework/theory.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::Mean;
using test::Measured;

struct TimeAverages {
  Measured rate, t_tr, t_rot;
};

constexpr int batch_count = 100;
constexpr double run_collisions = 2.5e5;

// Time averages of a run, the temperatures sampled twice per mean free time.
TimeAverages averages(const Scene& scene) {
  const double count = static_cast<double>(scene.needles.count);
  Simulation simulation(scene);
  const double step = simulation.mean_free_time() / 2;
  const int samples = static_cast<int>(4 * run_collisions / count / batch_count);
  Mean rate, t_tr, t_rot;
  std::uint64_t before = 0;
  int steps = 0;
  for (int batch = 0; batch < batch_count; ++batch) {
    double batch_tr = 0, batch_rot = 0;
    Totals totals;
    for (int sample = 0; sample < samples; ++sample) {
      Scene::Until until;
      until.time = ++steps * step;
      simulation.advance(until);
      totals = simulation.totals();
      batch_tr += totals.t_tr / samples;
      batch_rot += totals.t_rot / samples;
    }
    rate.add(2 * static_cast<double>(totals.collisions - before) / (count * samples * step));
    before = totals.collisions;
    t_tr.add(batch_tr);
    t_rot.add(batch_rot);
  }
  return {rate.measured(), t_tr.measured(), t_rot.measured()};
}

struct FiniteGas {
  std::uint64_t count;
  double gap = 0;         ///< between walls along z, if there are any
  bool has_bath = false;  ///< these walls are thermal; without walls there is a thermostat
};

class FiniteCount : public testing::TestWithParam<FiniteGas> {};

TEST_P(FiniteCount, RateAndTemperaturesAreExact) {
  const auto [needles, gap, has_bath] = GetParam();
  const double count = static_cast<double>(needles);
  const double side = 2.5;
  Scene scene = test::scene_of(needles, side, 2024);
  SCOPED_TRACE(test::name_of(scene));
  double factor = 1, volume = side * side * side;
  int conserved = 3;
  if (gap > 0) {
    scene.needles.box[2] = gap;
    scene.walls = {{.axis = "z", .side = "both"}};
    factor = theory::pair_factor_between_walls({}, {1, 1}, {}, {1, 1}, gap);
    volume *= gap / side;
    conserved = 2;
    if (has_bath) scene.walls[0].temperature = 1;
  } else if (has_bath) {
    scene.driving.andersen = {.rate = 1, .temperature = 1};
  }
  if (has_bath) conserved = 0;
  const TimeAverages run = averages(scene);

  const double energy = 2.5 * count, temperature = 2 * energy / (5 * count - conserved);
  const double share = 1 - conserved / (3 * count);
  const double exact =
      has_bath ? theory::collision_rate((count - 1) / volume, {1, 1}, scene.needles.k)
               : theory::equilibrium_rate(count, volume, energy, scene.needles.k, conserved);
  const Measured rate = run.rate / (factor * exact);
  const Measured t_rot = run.t_rot / temperature;
  const Measured t_tr = run.t_tr / (temperature * share);
  std::cout << "rate / exact: " << rate << ", T_tr: " << t_tr << ", T_rot: " << t_rot << '\n';
  EXPECT_TRUE(test::agrees(rate, 1, 3));
  EXPECT_LT(rate.error, 0.003);
  EXPECT_TRUE(test::agrees(t_tr, 1, 3));
  EXPECT_TRUE(test::agrees(t_rot, 1, 3));

  const double infinite = factor * theory::collision_rate(count / volume, {1, 1}, scene.needles.k);
  EXPECT_FALSE(test::agrees(run.rate, infinite, 5));
  if (has_bath) return;
  // Energy is conserved, so the two temperatures are fully correlated.
  EXPECT_NEAR(run.t_tr.value / run.t_rot.value, share, 3 * (run.t_tr.error + run.t_rot.error));
  EXPECT_FALSE(test::agrees(run.t_rot, 1, 5));
}

std::string name_of_gas(const testing::TestParamInfo<FiniteGas>& each) {
  const FiniteGas& gas = each.param;
  const std::string count = std::to_string(gas.count);
  if (gas.has_bath) return count + (gas.gap > 0 ? "_between_thermal_walls" : "_in_a_thermostat");
  return count + (gas.gap > 0 ? "_between_walls" : "");
}

INSTANTIATE_TEST_SUITE_P(Needles, FiniteCount, testing::Values(FiniteGas{6}), name_of_gas);
INSTANTIATE_TEST_SUITE_P(Needles_long, FiniteCount,
                         testing::Values(FiniteGas{6, 1.4}, FiniteGas{24}, FiniteGas{24, 2.5},
                                         FiniteGas{6, 0, true}, FiniteGas{6, 1.4, true}),
                         name_of_gas);

}  // namespace
}  // namespace needlework
