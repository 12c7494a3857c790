// Hits on walls in C: what a callback is given, and the sums of each wall.
#include <cmath>
#include <vector>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::CSimulation;

TEST(CWalls, CountHitsAndImpulses) {
  const CSimulation gas(
      "needles = { count = 60, box = 5 }\n[[walls]]\naxis = \"y\"\nside = \"both\"\n");
  ASSERT_EQ(needlework_wall_count(gas), 2u) << gas.error.message;
  std::vector<needlework_happening> seen;
  const auto add = [](const needlework_happening* first, std::size_t count, void* user) {
    auto& all = *static_cast<std::vector<needlework_happening>*>(user);
    all.insert(all.end(), first, first + count);
    return 0;
  };
  EXPECT_EQ(needlework_set_happening_callback(gas, 10, add, &seen), NEEDLEWORK_OK);
  gas.run_to(100);
  EXPECT_EQ(gas.totals().collisions, 100u);
  std::uint64_t hits[2] = {};
  double impulse[2] = {};
  for (const needlework_happening& each : seen) {
    if (each.kind == NEEDLEWORK_KIND_PAIR) continue;
    ASSERT_EQ(each.kind, NEEDLEWORK_KIND_WALL);
    ASSERT_LT(each.event.second, 2u);
    ++hits[each.event.second];
    impulse[each.event.second] += std::abs(each.event.impulse[1]);
    EXPECT_EQ(std::abs(each.event.arm_first), 0.5);
    EXPECT_LT(each.event.normal_velocity, 0);
  }
  for (const std::size_t n : {0u, 1u}) {
    needlework_wall wall{};
    EXPECT_EQ(needlework_get_wall(gas, n, &wall), NEEDLEWORK_OK);
    EXPECT_EQ(wall.axis, 1);
    EXPECT_EQ(wall.high, static_cast<int>(n));
    EXPECT_EQ(wall.hits, hits[n]);
    EXPECT_GT(wall.hits, 5u);
    EXPECT_NEAR(wall.impulse, impulse[n], 1e-12 * impulse[n]);
    EXPECT_EQ(wall.normal_impulse, wall.impulse);
    EXPECT_EQ(wall.area, 25);
    EXPECT_TRUE(std::isnan(wall.phase));
    EXPECT_NEAR(wall.energy, 0, 1e-14);
  }
  needlework_wall none{};
  EXPECT_EQ(needlework_get_wall(gas, 2, &none), NEEDLEWORK_USAGE);
  EXPECT_EQ(gas.message(), "index = 2: expected that of one of 2 walls");
  EXPECT_EQ(needlework_get_wall(gas, 0, nullptr), NEEDLEWORK_USAGE);
}

TEST(CWalls, MoveTheBoxThatRunsBeginFrom) {
  const std::string scene =
      "needles.count = 60\n"
      "walls = [{ axis = \"z\", side = \"low\", motion = { velocity = 0.5 } },\n"
      "         { axis = \"z\", side = \"high\", motion = { velocity = 0.25 } }]\n";
  const CSimulation gas("needles.box = 5\n" + scene);
  needlework_limits limits{};
  limits.time = 2;
  ASSERT_EQ(needlework_run_until(gas, &limits, nullptr), NEEDLEWORK_OK) << gas.message();
  double box[3], low[3];
  ASSERT_EQ(needlework_get_box(gas, box), NEEDLEWORK_OK);
  EXPECT_EQ(box[1], 5);
  EXPECT_EQ(box[2], 4.5);
  std::vector<double> r(180), v(180), u(180), w(180);
  needlework_state into{};
  into.position.data = r.data();
  into.velocity.data = v.data();
  into.orientation.data = u.data();
  into.angular_velocity.data = w.data();
  into.low = low;
  ASSERT_EQ(needlework_get_state(gas, &into), NEEDLEWORK_OK);
  EXPECT_EQ(low[0], 0);
  EXPECT_EQ(low[2], 1);

  needlework_initial initial{};
  initial.count = 60;
  for (int axis = 0; axis < 3; ++axis) initial.box[axis] = box[axis], initial.low[axis] = low[axis];
  initial.position.data = r.data();
  initial.velocity.data = v.data();
  initial.orientation.data = u.data();
  initial.angular_velocity.data = w.data();
  const CSimulation again(scene, initial);
  ASSERT_TRUE(again) << again.error.message;
  std::vector<double> moved(180);
  needlework_state look{};
  look.position.data = moved.data();
  look.low = low;
  ASSERT_EQ(needlework_get_state(again, &look), NEEDLEWORK_OK);
  EXPECT_EQ(low[2], 0);
  for (std::size_t n = 2; n < 180; n += 3) {
    EXPECT_EQ(moved[n], r[n] - 1);
    EXPECT_EQ(moved[n - 1], r[n - 1]);
  }
  limits.time = 1;
  ASSERT_EQ(needlework_run_until(again, &limits, nullptr), NEEDLEWORK_OK) << again.message();
  ASSERT_EQ(needlework_get_box(again, box), NEEDLEWORK_OK);
  EXPECT_EQ(box[2], 4.25);
  // Walls without a stop leave no more room at some time.
  limits.time = 0;
  limits.collisions_per_needle = 1e9;
  int stop = -1;
  ASSERT_EQ(needlework_run_until(again, &limits, &stop), NEEDLEWORK_OK) << again.message();
  EXPECT_EQ(stop, NEEDLEWORK_STOP_WALLS_MEET);
}

TEST(CEnergyBudget, IsTheChangeOfTheEnergy) {
  const CSimulation gas(
      "needles = { count = 60, box = 5 }\ncollisions = { epsilon = 0.8, tc_relative = 1e-3 }\n"
      "driving.kicks = { every = 0.05, translational = 1, rotational = 1 }\n"
      "driving.andersen = { rate = 0.5, temperature = 2 }\n"
      "[[walls]]\naxis = \"y\"\nside = \"both\"\n"
      "motion = { amplitude = 0.1, frequency = 1 }\n");
  gas.run_to(100);
  needlework_energy_budget budget{};
  ASSERT_EQ(needlework_get_energy_budget(gas, &budget), NEEDLEWORK_OK) << gas.error.message;
  const needlework_totals totals = gas.totals();
  EXPECT_NEAR(
      budget.pairs + budget.walls + budget.thermostat + budget.kicks + budget.velocities_set,
      totals.energy - totals.initial_energy, 1e-12);
  EXPECT_LT(budget.pairs, 0);
  EXPECT_GT(budget.kicks, 0);
  EXPECT_NE(budget.thermostat, 0);
  EXPECT_EQ(budget.velocities_set, 0);
  needlework_wall low{}, high{};
  EXPECT_EQ(needlework_get_wall(gas, 0, &low), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_get_wall(gas, 1, &high), NEEDLEWORK_OK);
  EXPECT_EQ(low.energy + high.energy, budget.walls);
  EXPECT_NE(budget.walls, 0);
  EXPECT_NEAR(low.phase, std::fmod(2 * 3.14159265358979323846 * totals.time, 6.283185307179586),
              1e-9);
  EXPECT_EQ(needlework_get_energy_budget(gas, nullptr), NEEDLEWORK_USAGE);
}

TEST(CWalls, AreNoneInAPeriodicBox) {
  const CSimulation gas(test::cooling);
  EXPECT_EQ(needlework_wall_count(gas), 0u);
  EXPECT_EQ(needlework_wall_count(nullptr), 0u);
}

}  // namespace
}  // namespace needlework
