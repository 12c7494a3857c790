// Kicks and the thermostat: when kicks come, and what they and redraws give.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "src/effects/driving/kicks.h"
#include "tests/engine/effect_scenes.h"
#include "tests/support/all_near.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

// A kick is at the end of its instant: a run that ends there has had it, with all its energy.
TEST(Kicks, ComeAtTheMultiplesOfTheirInterval) {
  Scene scene = test::scene_of(30, 6);
  scene.driving.kicks = {.every = 0.125, .translational = 1, .rotational = 0};
  scene.initial.t_tr = scene.initial.t_rot = 0;
  Simulation simulation(scene);
  simulation.advance(test::until_time(std::nextafter(0.125, 0.0)));
  EXPECT_EQ(simulation.totals().energy, 0);
  simulation.advance(test::until_time(0.125));
  const double energy = simulation.totals().energy;
  EXPECT_GT(energy, 0);
  simulation.advance(test::until_time(0.249));
  EXPECT_NEAR(simulation.totals().energy, energy, 1e-14);
  simulation.advance(test::until_time(0.25));
  EXPECT_NE(simulation.totals().energy, energy);
}

TEST(Kicks, GiveNoMomentum) {
  for (const char* name : {"kicked", "driven_mixture"}) {
    Scene scene = test::effect_scene(name);
    scene.driving = {};
    State state = draw_initial_state(scene);
    for (auto& v : state.velocity) v[1] += 0.5;  // so that there is some from the start
    scene.driving.kicks = {.every = 0.01, .translational = 3, .rotational = 3};
    Simulation simulation(scene, state);
    const auto before = simulation.totals().momentum;
    EXPECT_GT(before[1], 10);
    simulation.advance(test::until_time(1));
    const auto after = simulation.totals().momentum;
    EXPECT_TRUE(test::all_near(after, before, 1e-10));
  }
}

// Late in a run, too: n times the interval, not sums of it.
TEST(Kicks, DoNotDriftLateInARun) {
  const Clock clock(1);
  const Kicks kicks({.every = 0.1});
  for (const std::uint64_t n : {std::uint64_t{1}, std::uint64_t{1} << 30, std::uint64_t{1} << 40}) {
    const Time time = kicks.time(clock, n), next = kicks.time(clock, n + 1);
    const double since_start = clock.since_start(time);
    EXPECT_NEAR(since_start, 0.1 * static_cast<double>(n), 0x1p-52 * since_start) << n;
    EXPECT_NEAR(clock.difference(next, time), 0.1, 0x1p-51 * since_start) << n;
  }
  // 0.1 is a little more than a tenth, but who asks for ten kicks asks for 10 * 0.1.
  EXPECT_EQ(kicks.time(clock, 10), clock.add({}, 1.0));
}

TEST(Kicks, EndWithTheRunThatEndsWithThem) {
  Scene scene = test::scene_of(50, 6);
  scene.driving.kicks = {.every = 0.05, .translational = 1, .rotational = 0};
  Simulation to_the_kick(scene), beyond(scene);
  to_the_kick.advance(test::until_time(0.5));
  beyond.advance(test::until_time(0.5000001));
  EXPECT_EQ(to_the_kick.totals().energy, beyond.totals().energy);
}

// The loop goes on with what it has found out about its threads: so few collisions are between two
// kicks that none would get to know it anew.
TEST(Kicks, LetThreadsWorkTogether) {
  Scene scene = test::scene_of(2000, 9);
  scene.driving.kicks = {.every = 0.1, .translational = 0.1, .rotational = 0.1};
  scene.engine.search = "linked-cells";
  scene.engine.threads = 2;
  Simulation simulation(scene);
  simulation.advance(test::until_collisions(4));
  EXPECT_GT(simulation.time(), 5 * 0.1);
  EXPECT_GT(simulation.counters().phases, 0u);
}

// One needle never collides, but is kicked. The momentum it gets is taken off at once.
TEST(Kicks, TurnASingleNeedle) {
  Scene scene = test::scene_of(1, 6);
  scene.driving.kicks = {.every = 0.1, .translational = 1, .rotational = 1};
  Simulation simulation(scene);
  const State before = simulation.copy();
  EXPECT_EQ(simulation.advance(test::until_time(1)), Stop::time);
  const State after = simulation.copy();
  EXPECT_TRUE(test::all_near(after.velocity, before.velocity, 1e-14));
  EXPECT_NE(after.angular_velocity, before.angular_velocity);
}

// An account in quanta of the cold gas would overflow.
TEST(Thermostat, HeatsAGasFromNearlyNothing) {
  for (const double cold : {0.0, 1e-30, 1e-6}) {
    Scene scene = test::scene_of(100, 6);
    scene.initial.t_tr = scene.initial.t_rot = cold;
    scene.driving.andersen = {.rate = 1, .temperature = 1e3};
    Simulation simulation(scene);
    simulation.advance(test::until_time(4));
    EXPECT_NEAR(simulation.totals().energy / 2.5e3, 1, 0.3) << cold;
    EXPECT_LT(std::abs(simulation.energy_drift()), 1e-11) << cold;
    EXPECT_GT(simulation.collisions(), 1000u) << cold;
  }
}

}  // namespace
}  // namespace needlework
