// Kicks and the thermostat: one trajectory whatever finds the next event, however a run is divided.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kernels/isa.h"
#include "needlework/error.h"
#include "src/calendar/names.h"
#include "src/effects/driving/kicks.h"
#include "tests/support/same_run.h"

namespace needlework {
namespace {

struct DrivenScene {
  std::string name;
  Scene scene;
};

Scene inelastic(std::uint64_t count, double side) {
  Scene scene = test::scene_of(count, side, 3);
  scene.collisions.epsilon = 0.8;
  scene.collisions.tc_relative = 1e-3;
  return scene;
}

Scene mixture(double side) {
  Scene scene = inelastic(0, side);
  scene.species = {{.name = "short", .count = 120, .length = 0.7, .mass = 0.3, .k = 3},
                   {.name = "long", .count = 40, .length = 1.8, .mass = 4}};
  return scene;
}

std::vector<DrivenScene> driven_scenes() {
  std::vector<DrivenScene> out{
      {"kicked", inelastic(160, 5)},       {"thermostat", inelastic(160, 5)},
      {"often kicked", inelastic(160, 5)}, {"both, mixture", mixture(6)},
      {"from rest", inelastic(160, 5)},    {"kicked and shaken, falling", inelastic(160, 5)}};
  out[0].scene.driving.kicks = {.every = 0.11, .translational = 1, .rotational = 2};
  out[1].scene.driving.andersen = {.rate = 0.9, .temperature = 2};
  out[2].scene.driving.kicks = {.every = 1e-3, .translational = 1, .rotational = 2};
  out[3].scene.driving.kicks = {.every = 0.07, .translational = 0.5, .rotational = 1};
  out[3].scene.driving.andersen = {.rate = 0.3, .temperature = 1};
  out[4].scene.driving.kicks = {.every = 0.2, .translational = 8, .rotational = 0};
  out[4].scene.initial.t_tr = out[4].scene.initial.t_rot = 0;
  Scene& shaken = out[5].scene;
  shaken.driving.kicks = {.every = 0.05, .translational = 1, .rotational = 2};
  shaken.forces.gravity = {0, 0, -2};
  Scene::Wall& floor = shaken.walls.emplace_back();
  floor.axis = "z";
  floor.side = "low";
  floor.epsilon = 0.9;
  floor.motion = {.amplitude = 0.1, .frequency = 2, .phase = 0};
  return out;
}

constexpr double end = 0.6;

test::Recorded run(const Scene& scene, const std::vector<double>& stops = {}) {
  test::Followed followed(scene);
  for (const double stop : stops) followed->advance(test::until_time(stop));
  followed->advance(test::until_time(end));
  return followed.recorded();
}

// Of each search, one calendar and instruction set after the other, or all calendars.
void expect_one_trajectory(bool all_calendars) {
  std::size_t n = 0;
  const auto calendars = calendar_names();
  const auto isas = kernels::available();
  for (const DrivenScene& named : driven_scenes()) {
    Scene scene = named.scene;
    scene.engine.search = "all-pairs";
    scene.engine.queue = "lazy-heap";
    const test::Recorded truth = run(scene);
    EXPECT_GT(truth.collisions.size(), 40u) << named.name;
    Scene undriven = scene;
    undriven.driving = {};
    EXPECT_NE(run(undriven).hash, truth.hash) << named.name;
    for (const char* search : {"linked-lists", "linked-cells", "capsules", "auto"}) {
      for (std::size_t each = 0; each < (all_calendars ? calendars.size() : 1); ++each, ++n) {
        scene.engine.search = search;
        scene.engine.queue = calendars[n % calendars.size()];
        scene.engine.isa = kernels::name_of(isas[n % isas.size()]);
        scene.engine.storage = n % 2 == 0 ? "sorted" : "by-id";
        SCOPED_TRACE(named.name + ", " + search + ", " + scene.engine.queue + ", " +
                     scene.engine.isa);
        ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, run(scene)));
      }
    }
  }
}

TEST(Driving, HasOneTrajectory) { expect_one_trajectory(false); }

TEST(Driving, HasOneTrajectoryOnEveryCalendar_long) { expect_one_trajectory(true); }

TEST(Driving, HasOneTrajectoryOnThreads) {
  for (const DrivenScene& named : driven_scenes()) {
    Scene scene = named.scene;
    const test::Recorded truth = run(scene);
    for (const int threads : {2, 3}) {
      for (const char* search : {"linked-cells", "capsules"}) {
        scene.engine.search = search;
        scene.engine.threads = threads;
        scene.engine.team = "all";
        SCOPED_TRACE(named.name + ", " + search + ", threads " + std::to_string(threads));
        ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, run(scene)));
      }
    }
  }
}

// Also where it is stopped at the instant of a kick, and between two.
TEST(Driving, DoesNotDependOnStops) {
  for (const DrivenScene& named : driven_scenes()) {
    SCOPED_TRACE(named.name);
    const test::Recorded truth = run(named.scene);
    ASSERT_NO_FATAL_FAILURE(
        test::expect_same(truth, run(named.scene, {0.0, 0.07, 0.11, 0.11, 0.2, 0.33, 0.5})));
    // Later times are sums of others in the test, as a clock may have them.
    ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, run(named.scene, {0.05, 0.22, 0.4, end})));
  }
}

TEST(Driving, GoesOnFromACheckpoint) {
  for (const DrivenScene& named : driven_scenes()) {
    SCOPED_TRACE(named.name);
    const test::Recorded truth = run(named.scene);
    for (const double stop : {0.0, 0.1, 0.11, 0.25}) {
      test::Followed first(named.scene);
      first->advance(test::until_time(stop));
      test::Followed second(named.scene, first->checkpoint());
      second.collisions = first.collisions;
      second->advance(test::until_time(end));
      ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, second.recorded())) << stop;
      Scene other = named.scene;
      if (other.driving.kicks) other.driving.kicks->rotational += 1;
      if (other.driving.andersen) other.driving.andersen->rate += 1;
      EXPECT_THROW(Simulation(other, first->checkpoint()), InputError);
      other = named.scene;
      other.needles.seed += 1;
      EXPECT_THROW(Simulation(other, first->checkpoint()), InputError);
    }
  }
}

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
  for (Scene scene : {inelastic(50, 6), mixture(6)}) {
    State state = draw_initial_state(scene);
    for (auto& v : state.velocity) v[1] += 0.5;  // so that there is some from the start
    scene.driving.kicks = {.every = 0.01, .translational = 3, .rotational = 3};
    Simulation simulation(scene, state);
    const auto before = simulation.totals().momentum;
    EXPECT_GT(before[1], 10);
    simulation.advance(test::until_time(1));
    const auto after = simulation.totals().momentum;
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(after[axis], before[axis], 1e-10);
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
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(after.velocity[0][axis], before.velocity[0][axis], 1e-14);
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
