// Channels: gravity along a periodic axis, beside thermal walls.
#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace needlework::test
