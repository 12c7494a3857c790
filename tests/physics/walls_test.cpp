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

TEST(WallPressure, IsThatOfTheIdealGasOfNeedles) {
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

// p(z) is exp(-m g z / T) min(1, 2 z / L), the force on the floor N m g.
TEST(NeedlesOnAFloor, HaveTheBarometricDensity) {
  constexpr std::uint64_t count = 500;
  constexpr double pull = 1;
  Mean below, height, force;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Scene scene = test::scene_of(count, 14, seed);
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
      lower.add(under / count);
      mean_height.add(sum / count);
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
    force.add(impulse / (samples * every * count * pull));
  }
  EXPECT_TRUE(agrees(below.measured(), 1, 3));
  EXPECT_TRUE(agrees(height.measured(), 1, 3));
  EXPECT_TRUE(agrees(force.measured(), 1, 3));
  EXPECT_LT(height.measured().error, 0.003);
  EXPECT_LT(force.measured().error, 0.003);
}

// Walls of two temperatures alike bring an inelastic-free gas to theirs.
TEST(ThermalWalls, BringTheGasToTheirTemperature) {
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
}

}  // namespace
}  // namespace needlework
