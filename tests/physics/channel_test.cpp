// Channels: gravity along a periodic axis, beside thermal walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "tests/support/runs.h"
#include "tests/support/statistics.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

constexpr double pull = 0.2;

Scene channel(std::uint64_t count, double side, double height, std::uint64_t seed) {
  Scene scene = scene_of(count, side, seed);
  scene.needles.box[2] = height;
  scene.walls = {wall("z", "both")};
  scene.walls[0].temperature = 1;
  scene.forces.gravity = {pull, 0, 0};
  return scene;
}

// At any moment, between hits too.
TEST(Channel, GivesItsWallsTheMomentumOfGravity) {
  Scene rods = channel(0, 8, 4, 2);
  rods.needles.count = 0;
  rods.species = {{.name = "spheres", .count = 50, .length = 0, .mass = 2, .diameter = 0.7},
                  {.name = "rods", .count = 50, .length = 1, .diameter = 0.3}};
  for (const Scene& scene : {channel(200, 6, 5, 1), rods}) {
    Simulation gas(scene);
    const double start = gas.totals().momentum[0];
    const double mass = scene.species.empty() ? 200 : 150;
    double taken = 0, most = 0;
    gas.on_happening([&](const Happening& h) {
      if (h.kind != Happening::wall) return;
      taken -= h.event.impulse[0];
      most += std::abs(h.event.impulse[0]);
    });
    for (const double time : {0.001, 0.7, 3.1, 20.0}) {
      gas.advance(until_time(time));
      EXPECT_NEAR(gas.totals().momentum[0] - start, mass * pull * time - taken,
                  1e-12 * (most + mass * pull * time))
          << time;
    }
    EXPECT_GT(most, mass * pull);
  }
}

// In the steady state walls take N m g along the field and, as heat, its work. The field is weak,
// so that the gas stays near their temperature; errors are those of blocks.
void expect_steady_state(double time, int blocks, double largest_error) {
  Simulation gas(channel(400, 8, 8, 3));
  double taken = 0;
  gas.on_happening([&](const Happening& h) {
    if (h.kind == Happening::wall) taken -= h.event.impulse[0];
  });
  gas.advance(until_time(100));
  Mean force, heat;
  double work = 0, of_walls = 0;
  const auto add_block = [&](double end) {
    const double taken_before = taken, work_before = work, walls_before = of_walls;
    gas.advance(until_time(end));
    const EnergyBudget budget = gas.energy_budget();
    work = *budget.gravity;
    of_walls = budget.walls[0] + budget.walls[1];
    force.add((taken - taken_before) / (400 * pull * time));
    heat.add(-(of_walls - walls_before) / (work - work_before));
  };
  work = *gas.energy_budget().gravity;
  of_walls = gas.energy_budget().walls[0] + gas.energy_budget().walls[1];
  for (int n = 1; n <= blocks; ++n) add_block(100 + n * time);
  EXPECT_GT(work, 0);
  EXPECT_LT(force.measured().error, largest_error);
  EXPECT_TRUE(agrees(force.measured(), 1, 4));
  EXPECT_TRUE(agrees(heat.measured(), 1, 4));
}

TEST(Channel, IsBrakedByItsWallsInTheSteadyState) { expect_steady_state(10, 16, 0.05); }

// Sums over samples of slabs of a channel: of velocities along the field, and of temperatures of
// the motion across it, which the flow does not enter.
struct Profile {
  static constexpr std::size_t slabs = 20;
  std::array<double, slabs> count{}, flow{}, warmth{};

  void add(const State& state, double low, double high) {
    for (std::size_t i = 0; i < state.size(); ++i) {
      const double place = (state.position[i][2] - low) / (high - low);
      const auto slab = std::min(static_cast<std::size_t>(place * slabs), slabs - 1);
      const auto& v = state.velocity[i];
      count[slab] += 1;
      flow[slab] += v[0];
      warmth[slab] += v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    }
  }
};

// a and b of the least squares fit of a + b x to points of these weights.
std::array<double, 2> line_through(const std::vector<std::array<double, 3>>& points) {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [weight, at, value] : points) {
    w += weight;
    x += weight * at;
    y += weight * value;
    xx += weight * at * at;
    xy += weight * at * value;
  }
  const double slope = (w * xy - x * y) / (w * xx - x * x);
  return {(y - slope * x) / w, slope};
}

// Elastic spheres whose mean free path is an eightieth of the channel flow as a fluid. With the
// stress n m g z at the distance z from the middle, u = u_0 - n m g z^2 / (2 eta); with the heat
// that the field has brought in below, T = T_0 - (n m g)^2 z^4 / (12 eta kappa). Coefficients are
// those of Chapman and Enskog with Enskog's factors of density. Fitted where walls are eight mean
// free paths away and more. Tolerances are for the scatter of this run, and for terms beyond Navier
// and Stokes, which bend the temperature upwards by some per cent of this: with a mean free path of
// a twentieth of the channel they take away most of it.
TEST(Channel, FlowsAsViscousFluidAndWarmsInItsMiddle_long) {
  constexpr double height = 41, pull_of_field = 0.0063;
  Scene scene;
  scene.needles.box = {8, 8, height};
  scene.needles.seed = 6;
  scene.species = {{.name = "spheres", .count = 768, .length = 0, .diameter = 1}};
  scene.walls = {wall("z", "both")};
  scene.walls[0].temperature = 1;
  scene.forces.gravity = {pull_of_field, 0, 0};
  Simulation gas(scene);
  gas.advance(until_time(400));
  Profile profile;
  constexpr int samples = 8000;
  for (int n = 1; n <= samples; ++n) {
    gas.advance(until_time(400 + n));
    profile.add(gas.copy(), 0.5, height - 0.5);
  }
  std::vector<std::array<double, 3>> flows, temperatures;
  double density = 0, temperature = 0, in_middle = 0;
  const double slab = (height - 1) / Profile::slabs;
  for (std::size_t n = 0; n < Profile::slabs; ++n) {
    const double z = (static_cast<double>(n) + 0.5) * slab - (height - 1) / 2;
    if (std::abs(z) > 0.4 * (height - 1)) continue;
    const double weight = profile.count[n], flow = profile.flow[n] / weight;
    const double t = (profile.warmth[n] / weight - flow * flow) / 3;
    flows.push_back({weight, z * z, flow});
    temperatures.push_back({weight, z * z * z * z, t});
    density += weight / (8 * 8 * slab * samples);
    temperature += t;
    in_middle += 1;
  }
  density /= in_middle;
  temperature /= in_middle;
  const double filled = 2 * std::numbers::pi / 3 * density;
  const double contact = (1 - filled / 8) / std::pow(1 - filled / 4, 3);
  const double eta = 1.016 * 5 / 16 * std::sqrt(temperature / std::numbers::pi) *
                     (1 / contact + 0.8 * filled + 0.7614 * filled * filled * contact);
  const double kappa = 1.025 * 75 / 64 * std::sqrt(temperature / std::numbers::pi) *
                       (1 / contact + 1.2 * filled + 0.7574 * filled * filled * contact);
  const double weight = density * pull_of_field;
  const double bend = -line_through(flows)[1] / (weight / (2 * eta));
  const double warming = -line_through(temperatures)[1] / (weight * weight / (12 * eta * kappa));
  std::cout << "flow / theory: " << bend << ", heating / theory: " << warming
            << ", temperature in the middle: " << line_through(temperatures)[0] << ", density "
            << density << '\n';
  EXPECT_NEAR(bend, 1, 0.06);
  EXPECT_NEAR(warming, 1, 0.35);
}

}  // namespace
}  // namespace needlework::test
