// Gases between walls and above a floor: the exact results of elastic equilibrium, in which
// positions and directors are those of an ideal gas.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "needlework/theory.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::agrees;
using test::Mean;
using test::until_time;

Scene between_walls(std::uint64_t count, double side, double height, std::uint64_t seed) {
  Scene scene = test::scene_of(count, side, seed);
  scene.needles.box[2] = height;
  scene.walls = {{.axis = "z", .side = "both"}};
  return scene;
}

// Hits of each wall per needle and time, and the force on it per needle, at temperature 1.
struct AtWalls {
  double hits, force;
};
AtWalls exact_at_walls(double height, double k) {
  double mean_speed = 0;
  constexpr int points = 2000;
  for (int n = 0; n < points; ++n) {
    const double u = (n + 0.5) / points;
    mean_speed += std::sqrt(1 + 0.5 * k * (1 - u * u)) / points;
  }
  const double room = height - 0.5;
  return {mean_speed / std::sqrt(2 * std::numbers::pi) / room, 1 / room};
}

TEST(WallPressure, IsThatOfTheIdealGasOfNeedles_long) {
  for (const auto& [height, k] : {std::pair(2.0, 6.0), std::pair(1.25, 2.0)}) {
    const AtWalls exact = exact_at_walls(height, k);
    if (k == 6) {
      EXPECT_NEAR(exact.hits, 0.4546, 5e-5);
      EXPECT_NEAR(exact.force, 0.6667, 5e-5);
    }
    constexpr std::uint64_t count = 1000;
    constexpr double side = 30;
    Mean hits, force, pairs;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      Scene scene = between_walls(count, side, height, seed);
      scene.needles.k = k;
      Simulation gas(scene);
      std::uint64_t all = 0;
      double impulse = 0;
      gas.on_happening([&](const Happening& h) {
        if (h.is_collision()) return;
        ++all;
        impulse += std::abs(h.event.impulse[2]);
      });
      constexpr double time = 80;
      gas.advance(until_time(time));
      // The temperature is that of the degrees of freedom that can change: 5 N less two for the
      // momentum along the walls.
      const Totals totals = gas.totals();
      const double per_needle = totals.energy - 0.5 *
                                                    (totals.momentum[0] * totals.momentum[0] +
                                                     totals.momentum[1] * totals.momentum[1]) /
                                                    count / count;
      const double temperature = 2 * per_needle * count / (5.0 * count - 2);
      hits.add(static_cast<double>(all) / (2 * count * time) / std::sqrt(temperature));
      force.add(impulse / (2 * count * time) / temperature);
      pairs.add(2.0 * static_cast<double>(totals.collisions) / (count * time) /
                std::sqrt(temperature));
    }
    EXPECT_TRUE(agrees(hits.measured(), exact.hits, 3)) << "k = " << k;
    EXPECT_TRUE(agrees(force.measured(), exact.force, 3)) << "k = " << k;
    EXPECT_LT(hits.measured().error, 0.003 * exact.hits);
    EXPECT_LT(force.measured().error, 0.003 * exact.force);
    Species needle;
    needle.k = k;
    const double rate = theory::collision_rate((count - 1) / (side * side * height), {1, 1}, k) *
                        theory::pair_factor_between_walls(needle, {1, 1}, needle, {1, 1}, height);
    EXPECT_TRUE(agrees(pairs.measured(), rate, 3));
    EXPECT_LT(pairs.measured().error, 0.003 * rate);
  }
}

// Of each two species, between walls that are nearer than two of their lengths.
TEST(PairsBetweenWalls, CollideAtTheRatesOfEachTwoSpecies_long) {
  constexpr double time = 320, error = 0.003;
  constexpr double side = 12, height = 1.3;
  Scene scene = between_walls(0, side, height, 1);
  scene.species = {{.name = "short", .count = 300, .length = 0.6, .mass = 0.5, .k = 4},
                   {.name = "long", .count = 200, .length = 1.1, .mass = 2, .k = 6}};
  const Composition composition = scene.composition();
  const std::vector<theory::Temperatures> warm(2, {1, 1});
  std::vector<double> exact =
      theory::mixture_rates(composition, side * side * height, warm).collisions;
  std::array<Mean, 3> found;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    scene.needles.seed = seed;
    Simulation gas(scene);
    const std::vector<SpeciesIndex> species = composition.in_order_of_id();
    std::array<double, 3> collisions{};
    gas.on_collision([&](const Collision& c) {
      ++collisions[composition.pair_index(species[c.first], species[c.second])];
    });
    gas.advance(until_time(time));
    // Momentum along the walls stays 0.
    const double temperature = 2 * gas.totals().energy * 500 / (5.0 * 500 - 2);
    for (std::size_t n = 0; n < 3; ++n) found[n].add(collisions[n] / time / std::sqrt(temperature));
  }
  for (std::size_t a = 0; a < 2; ++a) {
    for (std::size_t b = a; b < 2; ++b) {
      const std::size_t n = composition.pair_index(a, b);
      exact[n] *= theory::pair_factor_between_walls(composition[a], warm[a], composition[b],
                                                    warm[b], height);
      EXPECT_TRUE(agrees(found[n].measured(), exact[n], 3)) << n;
      EXPECT_LT(found[n].measured().error, error * exact[n]) << n;
    }
  }
}

// p(z) is exp(-m g z / T) min(1, 2 z / L), the force on the floor N m g. `error` is the relative
// standard error of the number of needles that the floor keeps from turning freely.
TEST(NeedlesOnAFloor, HaveTheBarometricDensity_long) {
  constexpr std::uint64_t count = 3000;
  const double side = 14 * std::sqrt(6.0), error = 0.003;
  constexpr double pull = 1;
  const auto all = static_cast<double>(count);
  Mean below, height, force;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Scene scene = test::scene_of(count, side, seed);
    scene.needles.box[2] = 3;
    scene.walls = {{.axis = "z", .side = "low"}};
    scene.forces.gravity = {0, 0, -pull};
    Simulation gas(scene);
    double impulse = 0;
    gas.on_happening([&](const Happening& h) {
      if (!h.is_collision()) impulse += h.event.impulse[2];
    });
    const double energy = gas.totals().energy;
    gas.advance(until_time(40));
    impulse = 0;
    Mean lower, mean_height, temperature;
    constexpr int samples = 100;
    constexpr double every = 1.5;
    for (int n = 1; n <= samples; ++n) {
      gas.advance(until_time(40 + every * n));
      const State state = gas.copy();
      double under = 0, sum = 0;
      for (const auto& r : state.position) {
        under += r[2] < 0.5;
        sum += r[2];
      }
      lower.add(under / all);
      mean_height.add(sum / all);
      const Totals totals = gas.totals();
      temperature.add((1.5 * totals.t_tr + totals.t_rot) / 2.5);
    }
    EXPECT_NEAR(gas.totals().energy, energy, 1e-10 * energy);
    EXPECT_LT(std::abs(gas.energy_drift()), 1e-10);
    const double t = temperature.measured().value, scale = t / pull, half = 0.5;
    // Integrals of 2 z exp(-z / scale) below half and of exp(-z / scale) above it, and with z.
    const double e = std::exp(-half / scale), s2 = scale * scale;
    const double low = 2 * (s2 - e * (s2 + scale * half)), high = scale * e;
    const double low_z =
        2 * (2 * s2 * scale - e * (2 * s2 * scale + 2 * s2 * half + scale * half * half));
    const double high_z = e * (s2 + scale * half);
    below.add(lower.measured().value / (low / (low + high)));
    height.add(mean_height.measured().value / ((low_z + high_z) / (low + high)));
    force.add(impulse / (samples * every * all * pull));
  }
  EXPECT_TRUE(agrees(below.measured(), 1, 3));
  EXPECT_TRUE(agrees(height.measured(), 1, 3));
  EXPECT_TRUE(agrees(force.measured(), 1, 3));
  EXPECT_LT(below.measured().error, error);
  EXPECT_LT(height.measured().error, 0.003);
  EXPECT_LT(force.measured().error, 0.003);
}

// Walls of two temperatures alike bring an inelastic-free gas to theirs.
TEST(ThermalWalls, BringTheGasToTheirTemperature_long) {
  constexpr double wall = 2.5;
  Mean t_tr, t_rot, elastic_hits;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scene scene = between_walls(400, 12, 2, seed);
    scene.walls[0].temperature = wall;
    scene.initial.t_tr = 1;
    scene.initial.t_rot = 0.1;
    Simulation gas(scene);
    gas.advance(until_time(30));
    Mean tr, rot;
    for (int n = 1; n <= 60; ++n) {
      gas.advance(until_time(30 + 2 * n));
      tr.add(gas.totals().t_tr);
      rot.add(gas.totals().t_rot);
    }
    t_tr.add(tr.measured().value / wall);
    t_rot.add(rot.measured().value / wall);
  }
  EXPECT_TRUE(agrees(t_tr.measured(), 1, 3));
  EXPECT_TRUE(agrees(t_rot.measured(), 1, 3));
  EXPECT_LT(t_tr.measured().error, 0.003);
  EXPECT_LT(t_rot.measured().error, 0.003);
}

// What the hot wall gives, the cold one takes; of walls of one temperature neither gives any.
TEST(ThermalWalls, CarryHeatFromTheHotOneToTheCold_long) {
  constexpr double time = 500, error = 0.003;
  for (const double hot : {3.0, 1.0}) {
    Mean from_low, from_high, balance;  // power per needle
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      Scene scene = between_walls(300, 10, 3, seed);
      scene.walls = {{.axis = "z", .side = "low", .temperature = hot},
                     {.axis = "z", .side = "high", .temperature = 1}};
      scene.initial.t_tr = scene.initial.t_rot = std::sqrt(hot);
      Simulation gas(scene);
      std::array<double, 2> given{};
      gas.on_happening([&](const Happening& h) {
        if (!h.is_collision()) given[h.event.second] += h.event.energy_change;
      });
      gas.advance(until_time(10));
      given = {};
      const double before = gas.totals().energy;
      gas.advance(until_time(10 + time));
      from_low.add(given[0] / (300 * time));
      from_high.add(given[1] / (300 * time));
      // To the last digit where the change of the energy is counted.
      EXPECT_NEAR((given[0] + given[1]) / 300, gas.totals().energy - before, 1e-9);
      balance.add((given[0] + given[1]) / (300 * time));
    }
    EXPECT_TRUE(agrees(balance.measured(), 0, 3)) << hot;
    if (hot > 1) {
      EXPECT_GT(from_low.measured().value, 50 * from_low.measured().error);
      EXPECT_LT(from_high.measured().value, -50 * from_high.measured().error);
      EXPECT_LT(balance.measured().error, error * from_low.measured().value);
    } else {
      EXPECT_TRUE(agrees(from_low.measured(), 0, 3));
      EXPECT_TRUE(agrees(from_high.measured(), 0, 3));
      EXPECT_LT(from_low.measured().error, 0.01);
    }
  }
}

}  // namespace
}  // namespace needlework
