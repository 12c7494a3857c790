// Energy that kicks and the thermostat give. Laws: theory::kick_power, exact for needles that
// collide elastically, as kicks change velocities by numbers that do not depend on them; and
// <E> = (5/2) (T_b + (T_0 - T_b) exp(-rate t)) for the thermostat, as each needle has been in
// contact with the bath or not, and elastic collisions keep the energy.
//
// Tolerance: 3 standard errors, from the scatter of the runs, each with a seed of its own.
#include <gtest/gtest.h>

#include <cmath>

#include "needlework/theory.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::agrees;
using test::Mean;

// Runs with seeds from that of the scene on; `look(simulation)` is the sample of one.
template <class Look>
test::Measured mean_of(Scene scene, int runs, double time, const Look& look) {
  Mean mean;
  for (int run = 0; run < runs; ++run, ++scene.needles.seed) {
    Simulation simulation(scene);
    const double before = simulation.totals().energy;
    simulation.advance(test::until_time(time));
    mean.add(look(simulation, before));
  }
  return mean.measured();
}

void expect_power(const Scene& scene, int runs, double kicks) {
  const Scene::Kicks& given = *scene.driving.kicks;
  const double time = kicks * given.every;
  const test::Measured power =
      mean_of(scene, runs, time, [&](const Simulation& simulation, double before) {
        return (simulation.totals().energy - before) / time;
      });
  const double expected =
      theory::kick_power(scene.composition(), given.translational, given.rotational);
  EXPECT_TRUE(agrees(power, expected, 3));
  EXPECT_LT(power.error, 0.003 * expected);
}

TEST(KickPower, IsExact) {
  Scene scene = test::scene_of(400, 8, 100);
  scene.initial.t_tr = scene.initial.t_rot = 0.05;
  scene.driving.kicks = {.every = 0.05, .translational = 1.5, .rotational = 4};
  expect_power(scene, 200, 10);
}

// Whatever collisions take meanwhile, which is a share of its own in the budget of energy.
TEST(KickPower, IsExactForInelasticNeedles_long) {
  Scene scene = test::inelastic(test::scene_of(400, 8, 4000), 0.7);
  scene.initial.t_tr = scene.initial.t_rot = 0.05;
  scene.driving.kicks = {.every = 0.05, .translational = 1.5, .rotational = 4};
  constexpr double time = 1;
  double taken = 0;
  const test::Measured power =
      mean_of(scene, 130, time, [&](const Simulation& simulation, double before) {
        const EnergyBudget budget = simulation.energy_budget();
        taken -= budget.pairs / 130;
        EXPECT_NEAR(budget.pairs + *budget.kicks, simulation.totals().energy - before, 1e-12);
        return *budget.kicks / time;
      });
  const double expected = theory::kick_power(scene.composition(), 1.5, 4);
  EXPECT_TRUE(agrees(power, expected, 3));
  EXPECT_LT(power.error, 0.003 * expected);
  EXPECT_GT(taken, 0.03 * expected);
}

// The momentum that is taken off is a quarter of what kicks give to four needles.
TEST(KickPower, IsExactForFewNeedles_long) {
  Scene scene = test::scene_of(4, 3, 1000);
  scene.initial.t_tr = scene.initial.t_rot = 0.01;
  scene.driving.kicks = {.every = 0.1, .translational = 1, .rotational = 0};
  expect_power(scene, 30000, 10);
}

TEST(KickPower, IsExactForMixtures_long) {
  Scene scene = test::scene_of(0, 5, 2000);
  scene.species = {
      {.name = "a", .count = 40, .length = 0.6, .mass = 0.5, .k = 3, .t_tr = 0.02, .t_rot = 0.02},
      {.name = "b", .count = 6, .length = 1.5, .mass = 20, .t_tr = 0.02, .t_rot = 0.02}};
  scene.driving.kicks = {.every = 0.1, .translational = 1, .rotational = 1};
  expect_power(scene, 8000, 10);
}

TEST(Thermostat, RelaxesExponentially_long) {
  Scene scene = test::scene_of(300, 7, 300);
  scene.initial.t_tr = 0.5;
  scene.initial.t_rot = 2;  // E = 2.75
  scene.driving.andersen = {.rate = 0.8, .temperature = 3};
  for (const double time : {0.5, 1.25, 3.0}) {
    const test::Measured energy =
        mean_of(scene, 250, time,
                [](const Simulation& simulation, double) { return simulation.totals().energy; });
    const double expected = 7.5 + (2.75 - 7.5) * std::exp(-0.8 * time);
    EXPECT_TRUE(agrees(energy, expected, 3)) << time;
    EXPECT_LT(energy.error, 0.003 * expected);
    scene.needles.seed += 1000;
  }
}

// It keeps no momentum, so that there is no factor (N - 1) / N, and all species are alike.
TEST(Thermostat, GivesItsTemperatureToFewNeedles_long) {
  Scene scene = test::scene_of(0, 4, 5000);
  scene.species = {{.name = "a", .count = 3, .mass = 0.5}, {.name = "b", .count = 1, .k = 2}};
  scene.driving.andersen = {.rate = 2, .temperature = 1.5};
  Mean t_tr[2], t_rot[2];
  for (int run = 0; run < 30000; ++run, ++scene.needles.seed) {
    Simulation simulation(scene);
    simulation.advance(test::until_time(6));
    const auto totals = simulation.species_totals();
    for (int n = 0; n < 2; ++n) {
      t_tr[n].add(totals[n].t_tr);
      t_rot[n].add(totals[n].t_rot);
    }
  }
  for (int n = 0; n < 2; ++n) {
    EXPECT_TRUE(agrees(t_tr[n].measured(), 1.5, 3)) << n;
    EXPECT_TRUE(agrees(t_rot[n].measured(), 1.5, 3)) << n;
  }
  EXPECT_LT(t_tr[0].measured().error, 0.003 * 1.5);
}

}  // namespace
}  // namespace needlework
