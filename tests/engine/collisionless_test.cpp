// Gases that can never collide end where no limit on time ends them, and no others do.
#include "src/physics/collisionless.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "needlework/error.h"
#include "needlework/simulation.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

using test::until_collisions;
using test::until_time;

// `change` is applied to the velocity, the director and the angular velocity of each needle.
template <class Change>
State changed(const Scene& scene, const Change& change) {
  State state = draw_initial_state(scene);
  for (std::size_t i = 0; i < state.size(); ++i) {
    change(i, state.velocity[i], state.orientation[i], state.angular_velocity[i]);
  }
  return state;
}

using Vector = std::array<double, 3>;

State parallel(const Scene& scene) {
  return changed(scene, [](std::size_t i, Vector&, Vector& u, Vector& w) {
    u = i % 2 == 0 ? Vector{0.6, 0, 0.8} : Vector{-0.6, 0, -0.8};
    w = {};
  });
}

State in_planes(const Scene& scene, int axis) {
  return changed(scene, [&](std::size_t i, Vector& v, Vector& u, Vector& w) {
    const double angle = 0.1 + static_cast<double>(i);
    u = w = {};
    u[(axis + 1) % 3] = std::cos(angle);
    u[(axis + 2) % 3] = std::sin(angle);
    w[axis] = angle;
    v[axis] = 0;
  });
}

void expect_no_end(const Scene& scene, const State& state) {
  Simulation simulation(scene, state);
  EXPECT_EQ(simulation.why_no_collision(), "");
  Scene::Until until = until_collisions(1e9);
  until.wall_s = 0;
  EXPECT_EQ(simulation.advance(until), Stop::wall_time);
}

TEST(Collisionless, ParallelNeedlesAndThoseInPlanesEnd) {
  const Scene scene = test::scene_of(500, 8);
  const auto expect_end = [&](const State& state, const std::string& why) {
    Simulation simulation(scene, state);
    EXPECT_EQ(simulation.why_no_collision(), why);
    EXPECT_EQ(simulation.advance(until_collisions(1)), Stop::nothing_can_happen);
    EXPECT_EQ(simulation.time(), 0);
    EXPECT_EQ(simulation.advance(until_time(0.5)), Stop::time);
    EXPECT_EQ(simulation.collisions(), 0u);
    EXPECT_EQ(simulation.advance(until_collisions(1)), Stop::nothing_can_happen);
    const State again = simulation.copy();
    EXPECT_EQ(Simulation(scene, again).why_no_collision(), why);
  };
  expect_end(parallel(scene), "all needles are parallel and do not rotate");
  for (int axis = 0; axis < 3; ++axis) {
    expect_end(
        in_planes(scene, axis),
        std::string("all needles lie and move in planes normal to the ") + "xyz"[axis] + " axis");
  }
}

// Without a search for each horizon, of which there would be millions, so that needles that leave
// the range of image counts on the way are noticed at once.
TEST(Collisionless, TimePassesWithoutEvents) {
  const Scene scene = test::scene_of(500, 8);
  for (const State& state : {parallel(scene), in_planes(scene, 2)}) {
    Simulation simulation(scene, state);
    EXPECT_EQ(simulation.advance(until_time(1e4)), Stop::time);
    EXPECT_EQ(simulation.counters().events, 0u);
    EXPECT_EQ(simulation.time(), 1e4);
    EXPECT_THROW(simulation.advance(until_time(1e12)), InvalidStateError);
    EXPECT_EQ(simulation.time(), 1e4);
  }
}

// A sphere meets no image of its own, so that theory knows no time of it.
TEST(Collisionless, OneSphereFliesForAsLongAsOneNeedle) {
  for (const double diameter : {0.0, 1.0}) {
    Scene scene;
    scene.needles.box = {3, 3, 3};
    scene.species = {{.name = "one",
                      .count = 1,
                      .length = diameter > 0 ? 0.0 : 1.0,
                      .t_tr = 1e-60,
                      .t_rot = diameter > 0 ? 0 : 1e-60,
                      .diameter = diameter}};
    Simulation simulation(scene);
    EXPECT_EQ(simulation.advance(until_time(1e32)), Stop::time) << diameter;
    EXPECT_EQ(simulation.time(), 1e32);
  }
}

TEST(Collisionless, TimePassesWithoutNeedlesBetweenWalls) {
  Scene scene = test::scene_of(0, 4);
  scene.walls = {{.axis = "z", .side = "both"}};
  Simulation simulation(scene);
  EXPECT_EQ(simulation.advance(until_time(1)), Stop::time);
}

TEST(Collisionless, OneNeedleThatDiffersIsEnough) {
  const Scene scene = test::scene_of(500, 8);
  for (const int differing : {0, 250, 499}) {
    State state = parallel(scene);
    state.orientation[differing] = {0.8, 0, 0.6};
    expect_no_end(scene, state);
    state = parallel(scene);
    state.angular_velocity[differing] = {0, 1e-300, 0};
    expect_no_end(scene, state);
    state = in_planes(scene, 2);
    state.velocity[differing][2] = 1e-300;
    expect_no_end(scene, state);
    state = in_planes(scene, 1);
    state.angular_velocity[differing][0] = 1e-9;
    state.angular_velocity[differing][1] = 0;
    state.orientation[differing] = {0, 0, 1};
    expect_no_end(scene, state);
  }
}

TEST(Collisionless, NeedlesSetInMotionGoOn) {
  const Scene scene = test::scene_of(20, 4);
  Simulation simulation(scene, parallel(scene));
  EXPECT_EQ(simulation.advance(until_time(3)), Stop::time);
  const State drawn = draw_initial_state(scene);
  simulation.set_velocities(drawn.velocity, drawn.angular_velocity);
  EXPECT_EQ(simulation.advance(until_collisions(2)), Stop::collisions);
}

// Two needles on their ways along an axis, past each other for ever, in a loop that is soon
// content.
struct Passing {
  Passing()
      : run(scene, make_gas(scene, passing())),
        loop(make_loop(run, {.search = "linked-cells", .calendar = "tournament"})) {
    run.windows.long_quiet = 64;
  }
  static State passing() {
    State state;
    state.box = {4, 4, 4};
    state.resize(2);
    state.id = {0, 1};
    state.position = {{0.5, 0.5, 0.5}, {0.5, 2.5, 0.5}};
    state.velocity = {{1, 0, 0}, {-1, 0, 0}};
    state.orientation = {{0, 1, 0}, {0, 0, 1}};
    state.angular_velocity = {{}, {}};
    return state;
  }

  Scene scene = test::scene_of(2, 4);
  Run run;
  std::unique_ptr<Loop> loop;
};

TEST(Collisionless, LongQuietIsAnEndUnlessThereIsALimitOnTime) {
  Passing passing;
  EXPECT_EQ(passing.loop->advance(StopConditions(passing.run, until_collisions(1))),
            Stop::nothing_can_happen);
  // For two needles it takes 16 times as long.
  const double window =
      passing.run.windows.end().epoch > 0 ? passing.run.windows.mean_free_time() : 0;
  const double quiet = passing.run.gas.clock.since_start(passing.run.now);
  EXPECT_GE(quiet, 16 * 64 * window / 2);
  EXPECT_LE(quiet, 16 * 64 * window * 2);
  EXPECT_TRUE(passing.run.is_quiet());
  EXPECT_FALSE(passing.run.collisionless());

  Passing with_limit;
  EXPECT_EQ(with_limit.loop->advance(StopConditions(with_limit.run, until_time(4 * quiet))),
            Stop::time);
}

// However dilute: a collision begins the count again.
TEST(Collisionless, CollisionsKeepAGasAlive) {
  const Scene scene = test::scene_of(2, 30);
  needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
  const auto loop = make_loop(run, {.search = "linked-cells", .calendar = "tournament"});
  run.windows.long_quiet = 4;  // 64 windows of two needles, and thousands until the end
  EXPECT_EQ(loop->advance(StopConditions(run, until_collisions(300))), Stop::collisions);
  EXPECT_GT(run.gas.clock.since_start(run.now), 200 * run.windows.mean_free_time());
}

}  // namespace
}  // namespace needlework
