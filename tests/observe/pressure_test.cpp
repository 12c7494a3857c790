// The pressure of rods: a mean over time, and what walls feel.
#include "src/observe/pressure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/rods.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"
#include "tests/support/wall.h"

namespace needlework::observe {
namespace {

using test::until_time;

PressureSums sums_of(const Simulation& gas) {
  return pressure_sums(gas.time(), gas.t_tr_integral(), gas.virial(), gas.wall_totals());
}

// By the trapezoidal rule in steps that are far shorter than a mean free time. T_tr falls to less
// than a third.
TEST(Pressure, OfACoolingGasIsTheMeanOverItsTime) {
  Scene scene = test::inelastic(test::rods_of(200, 0, 0.2, 3), 0.7);
  Simulation gas(scene);
  constexpr double step = 0.002;
  double integral = 0, before = gas.totals().t_tr;
  const double first = before;
  for (int n = 1; n <= 1000; ++n) {
    gas.advance(until_time(step * n));
    const double now = gas.totals().t_tr;
    integral += 0.5 * step * (before + now);
    before = now;
  }
  ASSERT_LT(before, first / 3);
  EXPECT_NEAR(gas.t_tr_integral(), integral, 0.01 * integral);
  const double volume = std::pow(scene.needles.box[0], 3);
  EXPECT_NEAR(Pressure(scene).between({}, sums_of(gas)),
              (200 * integral + gas.virial() / 3) / (2 * volume), 0.01 * integral / volume * 100);
  EXPECT_STREQ(Pressure(scene).meaning(), "mean over the run, by the virial");
}

// A gas of spheres keeps its temperature until a caller gives it another one.
TEST(Pressure, TakesTheTemperatureThatACallerSets) {
  Simulation gas(test::rods_of(40, 0, 0.1, 2));
  const double hot = gas.totals().t_tr;
  gas.advance(until_time(1.3));
  State state = gas.copy();
  for (auto& v : state.velocity)
    for (double& component : v) component *= 0.5;
  gas.set_velocities(state.velocity, state.angular_velocity);
  gas.advance(until_time(3));
  EXPECT_NEAR(gas.t_tr_integral(), hot * (1.3 + 1.7 / 4), 1e-12 * hot);
}

// The virial theorem along the normal of two walls, exact at any time t: the sum of m v_x^2 over
// time, and of x F_x over collisions and hits, is the change of the sum of m x v_x. Hits of spheres
// are at half a diameter from the walls, so that these feel
//   (N int T_xx dt + W_xx) / (A (H - D) t),
// up to that change and that of the momentum.
TEST(Pressure, OnWallsIsThatOfTheVirialWithTheirForce) {
  constexpr double height = 1.6, diameter = 1, side = 6;
  constexpr std::size_t count = 24;
  Scene scene = test::rods_of(count, 0, 0.2, 5);
  scene.needles.box = {height, side, side};
  scene.walls = {test::wall("x", "both")};
  Simulation gas(scene);
  const State start = gas.copy();
  std::vector<double> speed, since(count);
  for (const auto& v : start.velocity) speed.push_back(v[0]);
  double kinetic = 0, pairs = 0, moment = 0, low = 0, high = 0;
  const auto flown = [&](std::size_t i, double now) {
    kinetic += speed[i] * speed[i] * (now - since[i]);
    since[i] = now;
  };
  gas.on_happening([&](const Happening& h) {
    const Collision& c = h.event;
    flown(c.first, c.time);
    speed[c.first] = c.after[0].velocity[0];
    if (!h.is_collision()) {
      (c.second == 0 ? low : high) += std::abs(c.impulse[0]);
      return;
    }
    flown(c.second, c.time);
    speed[c.second] = c.after[1].velocity[0];
    pairs += (c.after[0].position[0] - c.after[1].position[0]) * c.impulse[0];
  });
  constexpr double time = 40;
  gas.advance(until_time(time));
  const State end = gas.copy();
  double momentum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    flown(i, time);
    moment += end.position[i][0] * end.velocity[i][0] - start.position[i][0] * start.velocity[i][0];
    momentum += end.velocity[i][0] - start.velocity[i][0];
  }
  const double mean = (kinetic + pairs - moment + momentum * height / 2) / (height - diameter);
  EXPECT_NEAR((low + high) / 2, mean, 1e-8 * mean);
  const double area = side * side;
  const double found = Pressure(scene).between({}, sums_of(gas));
  EXPECT_NEAR(found, mean / (area * time), 1e-8 * found);
  EXPECT_NEAR(found, (kinetic + pairs) / (area * (height - diameter) * time), 0.01 * found);
}

TEST(Pressure, IsNoneWhereGravityMakesItDependOnTheHeight) {
  Scene scene = test::rods_of(20, 0, 0.05, 5);
  scene.walls = {test::wall("z", "both")};
  scene.walls[0].temperature = 1;
  const PressureSums end{.time = 1, .t_tr_integral = 1, .virial = 0, .normal_impulse = 2};
  const double area = scene.needles.box[0] * scene.needles.box[1];
  EXPECT_DOUBLE_EQ(Pressure(scene).between({}, end), 2 / (2 * area));
  EXPECT_TRUE(std::isnan(Pressure(scene).between(end, end)));
  scene.forces.gravity[0] = 1;  // along the walls
  EXPECT_DOUBLE_EQ(Pressure(scene).between({}, end), 2 / (2 * area));
  scene.forces.gravity[2] = 1;
  EXPECT_TRUE(std::isnan(Pressure(scene).between({}, end)));
}

}  // namespace
}  // namespace needlework::observe
