// The first search of all needles can be stopped, saved and continued, and costs nothing where
// nothing can happen.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "needlework/simulation.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::until_collisions;
using test::until_time;

std::vector<Scene> engines(Scene scene) {
  std::vector<Scene> all;
  for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
    scene.engine.search = search;
    all.push_back(scene);
  }
  for (const int threads : {2, 3}) {
    scene = test::on_threads(scene, threads);
    all.push_back(scene);
  }
  return all;
}

std::string name_of(const Scene& scene) {
  return scene.engine.search + ", threads: " + std::to_string(scene.engine.threads.value_or(1));
}

Scene rough_gas() {
  Scene scene = test::scene_of(600, 5);
  scene.collisions = {.epsilon = 0.9, .beta = 0.2, .tc = {}, .tc_relative = 1e-2};
  return scene;
}

TEST(Prepare, IsStoppedBeforeTheFirstEventAndContinues_long) {
  const auto until = until_collisions(4);
  for (const Scene& scene : engines(rough_gas())) {
    SCOPED_TRACE(name_of(scene));
    Simulation whole(scene);
    EXPECT_EQ(whole.advance(until), Stop::collisions);

    Simulation stopped(scene);
    stopped.interrupt();
    EXPECT_EQ(stopped.prepare(until), Stop::interrupted);
    Scene::Until at_once = until;
    at_once.wall_s = 0;
    EXPECT_EQ(stopped.advance(at_once), Stop::wall_time);
    EXPECT_EQ(stopped.counters().searches, 0u);
    Simulation resumed(scene, stopped.checkpoint());
    // Wherever it is stopped meanwhile.
    Scene::Until little_by_little = until;
    for (double wall = 1e-5;; wall *= 1.5) {
      little_by_little.wall_s = wall;
      if (!stopped.prepare(little_by_little)) break;
    }
    EXPECT_EQ(stopped.collisions(), 0u);
    EXPECT_EQ(stopped.time(), 0);
    EXPECT_EQ(stopped.counters().searches, 600u);
    for (Simulation* simulation : {&stopped, &resumed}) {
      EXPECT_EQ(simulation->advance(until), Stop::collisions);
      EXPECT_EQ(simulation->trajectory_hash(), whole.trajectory_hash());
      EXPECT_EQ(simulation->totals().time, whole.totals().time);
    }
  }
}

// As the search of a checkpoint that is stopped while it prepares, and saved again.
TEST(Prepare, IsStoppedInTheMiddleOfARun) {
  for (const Scene& scene : engines(rough_gas())) {
    SCOPED_TRACE(name_of(scene));
    Simulation whole(scene), first(scene);
    EXPECT_EQ(whole.advance(until_collisions(4)), Stop::collisions);
    EXPECT_EQ(first.advance(until_collisions(2)), Stop::collisions);
    Simulation second(scene, first.checkpoint());
    Scene::Until little = until_collisions(4);
    little.wall_s = 1e-4;
    second.prepare(little);
    Simulation third(scene, second.checkpoint());
    EXPECT_EQ(third.advance(until_collisions(4)), Stop::collisions);
    EXPECT_EQ(third.trajectory_hash(), whole.trajectory_hash());
  }
}

TEST(Prepare, IsNotNeededForAnEndThatIsMet) {
  Simulation simulation(rough_gas());
  EXPECT_EQ(simulation.advance(until_collisions(0)), Stop::collisions);
  EXPECT_EQ(simulation.counters().searches, 0u);
}

// They would be searched again from the beginning of their flight, a million boxes ago.
TEST(Prepare, DoesNotSearchThePastOfNeedlesThatHadNoEventForLong) {
  for (const std::size_t count : {1, 3}) {
    for (const Scene& scene : engines(test::scene_of(count, 3))) {
      SCOPED_TRACE(name_of(scene) + ", needles: " + std::to_string(count));
      State state = draw_initial_state(scene);
      if (count > 1) {
        state.velocity.assign(count, {0.3, -0.4, 0.7});
        state.angular_velocity.assign(count, {});
      }
      Simulation old(scene, state);
      EXPECT_EQ(old.advance(until_time(1e6)), Stop::time);
      Simulation resumed(scene, old.checkpoint());
      EXPECT_EQ(resumed.prepare(until_time(2e6)), Stop::time);
      EXPECT_EQ(resumed.time(), 2e6);
      EXPECT_LE(resumed.counters().candidates, 200 * count);
      for (auto* const simulation : {&old, &resumed}) {
        std::vector<std::array<double, 3>> v(count), w(count);
        v[0] = {1, 2, 3};
        simulation->set_velocities(v, w);
        EXPECT_EQ(simulation->advance(until_time(simulation->time() + 10)), Stop::time);
        EXPECT_LE(simulation->counters().candidates, 20000 * count);
      }
    }
  }
}

}  // namespace
}  // namespace needlework
