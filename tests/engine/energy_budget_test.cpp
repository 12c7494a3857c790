// The budget of energy: what each effect has put in, whatever finds the next event.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "needlework/simulation.h"
#include "tests/engine/effect_scenes.h"
#include "tests/support/all_near.h"
#include "tests/support/real.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

using test::numbers_of;

double sum_of(const EnergyBudget& budget) {
  const std::vector<double> all = numbers_of(budget);
  return std::accumulate(all.begin(), all.end(), 0.0);
}

// At any time, relative to the energy exchanged; and each share is what its events report.
TEST(EnergyBudget, IsTheChangeOfTheEnergy) {
  for (const test::EffectScene& named : test::effect_scenes()) {
    SCOPED_TRACE(named.name);
    Simulation simulation(named.scene);
    const auto count = static_cast<double>(simulation.needles() - simulation.composition().fixed());
    const auto momentum = simulation.totals().momentum;
    const double start = simulation.totals().energy;
    // Quanta of energy are shares of what fast walls may bring about.
    double driven = 0;
    for (const Scene::Wall& wall : named.scene.walls) {
      const double speed = wall.motion ? wall.motion->velocity.value_or(0) : 0;
      for (const Species& species : simulation.composition().species())
        driven = std::max(driven, 2.5 * species.mass * (4 * speed * speed));
    }
    test::Wide pairs = 0, thermostat = 0, exchanged = 0;
    std::vector<test::Wide> walls(named.scene.wall_sides().size());
    simulation.on_happening([&](const Happening& h) {
      test::Wide& share = h.is_collision()            ? pairs
                          : h.kind == Happening::wall ? walls.at(h.event.second)
                                                      : thermostat;
      share += h.event.energy_change;
      exchanged += std::abs(h.event.energy_change);
    });
    for (const double time : {0.01, 0.05, 0.2, 0.21, 0.7, 1.0}) {
      simulation.advance(named.share_of_end(time));
      const EnergyBudget budget = simulation.energy_budget();
      const double scale =
          static_cast<double>(exchanged) / count + std::abs(budget.kicks.value_or(0));
      const double change = simulation.totals().energy - start;
      // The energies themselves are rounded.
      const double rounding = 1e-15 * (std::abs(start) + std::abs(start + change) + 2 * 5 * 4);
      EXPECT_NEAR(sum_of(budget), change, 1e-12 * scale + rounding) << time;
      const auto expect_share = [&](double found, const test::Wide& reported) {
        EXPECT_NEAR(found, static_cast<double>(reported) / count,
                    1e-14 * scale + 1e-16 * (std::abs(start) + driven))
            << time;
      };
      // What events of pairs and at walls report has the work of growth in it.
      if (named.scene.driving.growth) continue;
      expect_share(budget.pairs, pairs);
      expect_share(budget.thermostat.value_or(0), thermostat);
      EXPECT_EQ(budget.thermostat.has_value(), named.scene.driving.andersen.has_value());
      EXPECT_EQ(budget.kicks.has_value(), named.scene.driving.kicks.has_value());
      EXPECT_EQ(budget.velocities_set, 0);
      ASSERT_EQ(budget.walls.size(), walls.size());
      for (std::size_t n = 0; n < walls.size(); ++n) expect_share(budget.walls[n], walls[n]);
    }
    const EnergyBudget end = simulation.energy_budget();
    const bool elastic = named.scene.collisions.epsilon == 1;
    if (!named.scene.driving.growth) {
      EXPECT_LT(end.pairs, elastic ? 1e-12 : -0.01 * std::abs(start));
    }
    for (const double energy : numbers_of(end)) EXPECT_TRUE(std::isfinite(energy));
    EXPECT_LT(std::abs(simulation.energy_drift()), 1e-11);
    if (named.scene.walls.empty() && !named.scene.driving.andersen &&
        !named.scene.composition().has_fixed()) {
      EXPECT_TRUE(test::all_near(simulation.totals().momentum, momentum, 1e-10));
    }
  }
}

// Walls that come together put in ten thousand times the energy of the start within one window.
TEST(EnergyBudget, HoldsWhatWallsPutInAtOnce) {
  Scene scene = test::scene_of(0, 8);
  scene.needles.box = {8, 8, 1.1};
  scene.species = {{.name = "spheres", .count = 10, .length = 0, .t_tr = 0.01, .diameter = 1}};
  scene.needles.count = 10;
  scene.walls = {{.axis = "z",
                  .side = "low",
                  .motion = Scene::WallMotion{.amplitude = 0.0999999, .frequency = 1, .phase = 0}},
                 {.axis = "z", .side = "high"}};
  Simulation simulation(scene);
  const double start = simulation.totals().energy;
  double most = 0;
  for (const double time : {0.2, 0.21, 0.22, 0.23}) {
    simulation.advance(test::until_time(time));
    const double energy = simulation.totals().energy;
    most = std::max(most, energy);
    EXPECT_NEAR(sum_of(simulation.energy_budget()), energy - start, 1e-12 * most) << time;
  }
  EXPECT_GT(most, 1e4 * start);
}

// A floor that lets a needle down takes the energy below 0, far from that of the motion.
TEST(EnergyBudget, HoldsEnergiesBelowZero) {
  Scene scene = test::scene_of(1, 3);
  scene.needles = {.count = 1, .box = {3, 3, 2}, .seed = 3};
  scene.initial.t_tr = scene.initial.t_rot = 0.001;
  scene.forces.gravity[2] = -1;
  scene.collisions.tc = 1e-3;
  constexpr double lowest = -1.5707963;
  scene.walls = {
      {.axis = "z",
       .side = "low",
       .epsilon = 0.2,
       .motion = Scene::WallMotion{.amplitude = 0.9, .frequency = 0.001, .phase = lowest}},
      {.axis = "z",
       .side = "high",
       .motion = Scene::WallMotion{.amplitude = 1, .frequency = 0.001, .phase = lowest}}};
  Simulation simulation(scene);
  const double start = simulation.totals().energy;
  simulation.advance(test::until_time(6));
  const double end = simulation.totals().energy;
  EXPECT_LT(end, -0.8);
  EXPECT_NEAR(sum_of(simulation.energy_budget()), end - start, 1e-12);
}

// Velocities of a caller are a share of their own.
TEST(EnergyBudget, CountsVelocitiesThatACallerSets) {
  for (const test::EffectScene& named : test::effect_scenes()) {
    SCOPED_TRACE(named.name);
    Simulation simulation(named.scene);
    const double start = simulation.totals().energy;
    simulation.advance(named.share_of_end(0.4));
    State state = simulation.copy();
    const double before = simulation.totals().energy;
    for (auto& v : state.velocity) v[0] *= 2;
    simulation.set_velocities(state.velocity, state.angular_velocity);
    const double given = simulation.totals().energy - before;
    EXPECT_GT(given, 0.1);
    EXPECT_NEAR(simulation.energy_budget().velocities_set, given, 1e-12);
    simulation.advance(named.share_of_end(0.7));
    const EnergyBudget end = simulation.energy_budget();
    EXPECT_NEAR(end.velocities_set, given, 1e-12);
    EXPECT_NEAR(sum_of(end), simulation.totals().energy - start, 1e-12);
  }
}

TEST(EnergyBudget, OfElasticNeedlesIsNothing) {
  Scene scene = test::scene_of(100, 5);
  scene.walls = {{.axis = "z", .side = "both"}};
  Simulation simulation(scene);
  simulation.advance(test::until_time(2));
  const EnergyBudget budget = simulation.energy_budget();
  EXPECT_GT(simulation.wall_totals()[0].hits, 30u);
  for (const double energy : numbers_of(budget)) EXPECT_NEAR(energy, 0, 1e-14);
  const Simulation none(test::scene_of(0, 5));
  EXPECT_EQ(none.energy_budget().pairs, 0);
}

// A needle that stands on end bounces on a floor in motion: it takes what the floor gives, as a
// ball does, m ((2 V - v)^2 - v^2) / 2 at each hit.
TEST(EnergyBudget, OfAFloorInMotionIsThatOfABall) {
  Scene scene = test::scene_of(1, 4);
  scene.forces.gravity = {0, 0, -1};
  scene.walls = {{.axis = "z", .side = "low"}};
  scene.walls[0].motion = {.amplitude = 0.05, .frequency = 0.8, .phase = 0.4};
  State state = draw_initial_state(scene);
  state.position = {{2, 2, 2}};
  state.velocity = {{0, 0, 0}};
  state.orientation = {{0, 0, 1}};
  state.angular_velocity = {{0, 0, 0}};
  Simulation simulation(scene, state);
  const double omega = 2 * 3.14159265358979323846 * 0.8;
  double given = 0, after = 0, since = 0, height = 2;
  std::size_t hits = 0;
  simulation.on_happening([&](const Happening& h) {
    const double time = h.event.time - since;
    const double speed = after - time;
    height += after * time - time * time / 2;
    EXPECT_NEAR(height, 0.5 + 0.05 * std::sin(omega * h.event.time + 0.4), 1e-9);
    const double surface = 0.05 * omega * std::cos(omega * h.event.time + 0.4);
    after = 2 * surface - speed;
    given += (after * after - speed * speed) / 2;
    since = h.event.time;
    ++hits;
  });
  simulation.advance(test::until_time(20));
  EXPECT_GT(hits, 4u);
  EXPECT_GT(std::abs(given), 0.01);
  EXPECT_NEAR(simulation.energy_budget().walls.at(0), given, 1e-9);
}

}  // namespace
}  // namespace needlework
