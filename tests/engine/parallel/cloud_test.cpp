// A cloud of needles in a large box: the best search and sizes change as it spreads. Its trajectory
// is the same as with any single search, on any number of threads.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "tests/support/parallel_loops.h"
#include "tests/support/same_run.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::thin;
using test::until_collisions;

// 1000 needles, so many to L^3 where they are: 31, in a box of 0.064.
State cloud(const Scene& scene) {
  State state = draw_initial_state(scene);
  for (auto& r : state.position) {
    for (double& x : r) x = 10 + x / 8;
  }
  return state;
}

TEST(Cloud, IsFollowedAsItSpreads_long) {
  Scene scene = test::scene_of(1000, 25);
  const State state = cloud(scene);
  const auto until = until_collisions(150 / thin);
  scene.engine.search = "linked-lists";
  Simulation truth(scene, state);
  ASSERT_EQ(truth.advance(until), Stop::collisions);
  scene.engine.search = "auto";
  for (const int threads : {1, 2, 3}) {
    SCOPED_TRACE(threads);
    scene = test::on_threads(scene, threads);
    Simulation simulation(scene, state);
    EXPECT_EQ(simulation.search(), "capsules");
    EXPECT_EQ(simulation.prepare(until), std::nullopt);
    EXPECT_LT(simulation.counters().candidates, 600u * simulation.counters().searches);
    EXPECT_EQ(simulation.advance(until), Stop::collisions);
    EXPECT_EQ(simulation.trajectory_hash(), truth.trajectory_hash());
    EXPECT_EQ(simulation.totals().time, truth.totals().time);
    const Counters& counters = simulation.counters();
    if (thin == 1) {
      EXPECT_GE(counters.resized, 2u);
      EXPECT_LE(counters.resized, 8u);
      EXPECT_EQ(simulation.search(), "linked-cells");
    }
    if (threads > 1) {
      EXPECT_GT(counters.phases, 0u);
    }
  }
}

// Sizes that the scene sets are not changed.
TEST(Cloud, IsSearchedAsAskedFor) {
  Scene scene = test::scene_of(1000, 25);
  const State state = cloud(scene);
  const auto until = until_collisions(10 / thin);
  const auto resized = [&](const Scene& its) {
    Simulation simulation(its, state);
    EXPECT_EQ(simulation.advance(until), Stop::collisions);
    EXPECT_EQ(simulation.search(), its.engine.search);
    return simulation.counters().resized;
  };
  scene.engine.search = "linked-cells";
  scene.engine.cell_side = 5;
  EXPECT_EQ(resized(scene), 0u);
  scene.engine.search = "capsules";
  scene.engine.cell_side = {};
  scene.engine.capsule_radius = 0.5;
  EXPECT_EQ(resized(scene), 0u);
  scene.engine.search = "linked-lists";
  scene.engine.capsule_radius = {};
  EXPECT_EQ(resized(scene), 0u);
}

// A run can be continued by another loop at any time between two events.
TEST(Loops, MayFollowEachOther) {
  Scene scene = test::inelastic(test::scene_of(600, 7, 8), 0.9);
  scene.collisions.beta = 0.5;
  const double end = 40 / thin;
  Simulation truth(scene);
  truth.advance(until_collisions(end));

  needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
  StopConditions limits(run, until_collisions(end));
  std::optional<Stop> stop;
  for (int n = 0; !stop; ++n) {
    std::unique_ptr<Loop> loop;
    SearchSetup setup;
    setup.density = std::array{0.3, 1.0, 3.0}[n % 3];
    const auto one_thread = [&](const char* search, const char* calendar) {
      loop = make_loop(run, {.search = search, .calendar = calendar, .setup = setup});
    };
    if (n % 4 == 0) one_thread("linked-cells", "tournament");
    if (n % 4 == 1) {
      loop = test::parallel_loop(run, "capsules", 2, test::short_phases, setup);
    }
    if (n % 4 == 2) one_thread("linked-lists", "tournament");
    if (n % 4 == 3) one_thread("capsules", "cell-calendar");
    limits.pause = run.tally.collisions + 200 + 100 * static_cast<std::uint64_t>(n % 5);
    stop = loop->advance(limits);
    ASSERT_LT(n, 1000);
  }
  EXPECT_EQ(stop, Stop::collisions);
  EXPECT_EQ(run.tally.hash.hex(), truth.trajectory_hash());
}

// Also after each collision of many at one instant, here of 27 equal groups.
TEST(Loops, MayFollowEachOtherAtOneInstant) {
  Scene scene = test::scene_of(4, 3, 5);
  const State group = draw_initial_state(scene);
  State state;
  state.box = {9, 9, 9};
  for (int copy = 0; copy < 27; ++copy) {
    for (std::size_t n = 0; n < group.size(); ++n) {
      std::array<double, 3> r = group.position[n];
      const int steps[] = {copy % 3, copy / 3 % 3, copy / 9};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        r[axis] = std::round(r[axis] * 0x1p30) * 0x1p-30 + 3 * steps[axis];
      }
      state.position.push_back(r);
      state.velocity.push_back(group.velocity[n]);
      state.orientation.push_back(group.orientation[n]);
      state.angular_velocity.push_back(group.angular_velocity[n]);
    }
  }
  scene.collisions.epsilon = 0.8;
  scene.collisions.tc_relative = 1e-3;
  const std::uint64_t end = 270;
  std::set<double> instants;
  Simulation truth(scene, state);
  truth.on_collision([&](const Collision& collision) { instants.insert(collision.time); });
  truth.advance(until_collisions(2 * static_cast<double>(end) / 108));
  EXPECT_LT(instants.size(), end / 2);

  needlework::Run run(scene, make_gas(scene, state));
  for (std::uint64_t n = 0; n < end; ++n) {
    SearchSetup setup;
    setup.density = n % 2 ? 0.1 : 1.0;
    const char* search = std::array{"linked-cells", "capsules", "linked-lists"}[n % 3];
    const std::unique_ptr<Loop> loop =
        make_loop(run, {.search = search, .calendar = "tournament", .setup = setup});
    StopConditions limits(run, until_collisions(1e6));
    limits.collisions = static_cast<double>(n + 1);
    ASSERT_EQ(loop->advance(limits), Stop::collisions);
  }
  EXPECT_EQ(run.tally.hash.hex(), truth.trajectory_hash());
}

// A collapse of three needles or more is detected by the number of collisions at one instant, also
// if several loops have counted them.
TEST(Loops, CountTogetherWhatHappensAtOneInstant_long) {
  Scene scene = test::scene_of(60, 4, 6);
  scene.collisions.epsilon = 0.6;
  scene.collisions.beta = 0;
  const auto until = until_collisions(1000);
  const auto failure = [&](const auto& advance) -> std::string {
    try {
      advance();
    } catch (const InvalidStateError& error) {
      return error.what();
    }
    return "none";
  };
  Simulation one(scene);
  const std::string expected = failure([&] { one.advance(until); });
  EXPECT_NE(expected.find("collisions at one instant"), std::string::npos) << expected;

  needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
  StopConditions limits(run, until);
  const std::string message = failure([&] {
    for (;;) {
      const auto loop = make_loop(run, {.search = "linked-lists", .calendar = "tournament"});
      limits.pause = run.tally.collisions + 1000;
      if (loop->advance(limits)) return;
    }
  });
  EXPECT_EQ(message, expected);
}

// A loop that follows another does no more work than one that continues.
TEST(Loops, ContinueWhereOthersStopped) {
  const Scene scene = test::scene_of(1000, 11);
  const auto searches_of_half = [&](bool by_another) {
    needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
    StopConditions limits(run, until_collisions(40));
    limits.pause = 10000;
    const auto make = [&] {
      return make_loop(run, {.search = "linked-cells", .calendar = "tournament"});
    };
    std::unique_ptr<Loop> loop = make();
    EXPECT_EQ(loop->advance(limits), std::nullopt);
    limits.pause = std::numeric_limits<std::uint64_t>::max();
    if (by_another) {
      loop.reset();
      loop = make();
    }
    const std::uint64_t before = run.tally.counters.searches;
    EXPECT_EQ(loop->advance(limits), Stop::collisions);
    return static_cast<double>(run.tally.counters.searches - before);
  };
  EXPECT_NEAR(searches_of_half(true) / searches_of_half(false), 1, 0.03);
}

}  // namespace
}  // namespace needlework
