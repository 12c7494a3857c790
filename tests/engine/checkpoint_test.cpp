// A run that is stopped, saved and continued goes on as if it had not been stopped: to the last bit
// of every collision and of the state, whatever search, calendar, threads and instruction set it
// goes on with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kernels/isa.h"
#include "needlework/error.h"
#include "src/calendar/names.h"
#include "tests/engine/set_velocities.h"
#include "tests/support/same_run.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

struct SavedScene {
  std::string name;
  Scene scene;
};

std::vector<SavedScene> scenes() {
  std::vector<SavedScene> out{{"elastic", test::scene_of(200, 6, 3)},
                              {"cooling", test::scene_of(200, 6, 7)},
                              {"rough", test::scene_of(150, 4, 5)},
                              {"dense", test::scene_of(300, 2.9, 11)},
                              {"flat", test::scene_of(100, 3, 13)},
                              {"table", test::with_species(test::scene_of(100, 5, 2), 0.37, 2.5)}};
  out[1].scene.collisions = {.epsilon = 0.8, .beta = -1, .tc = {}, .tc_relative = 1e-2};
  out[2].scene.collisions = {.epsilon = 0.9, .beta = 0.3, .tc = 1e-3, .tc_relative = {}};
  out[3].scene.collisions = {.epsilon = 0.6, .beta = -1, .tc = {}, .tc_relative = 1e-1};
  out[4].scene.needles.box = {3, 7, 2.5};
  out[4].scene.initial.t_rot = 0;
  return out;
}

void expect_same_end(const test::Recorded& truth, const test::Recorded& other) {
  ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, other));
  EXPECT_EQ(truth.end.image, other.end.image);
  EXPECT_EQ(truth.totals.collisions, other.totals.collisions);
  EXPECT_EQ(truth.totals.tc_collisions, other.totals.tc_collisions);
  EXPECT_EQ(truth.totals.time, other.totals.time);
  EXPECT_EQ(truth.totals.energy, other.totals.energy);
  EXPECT_EQ(truth.totals.momentum, other.totals.momentum);
}

const double collisions = 1500 / test::thin;

// The n-th choice of what no trajectory depends on.
void choose_parts(Scene& scene, std::size_t n) {
  const std::vector<std::string> searches{"capsules", "linked-cells", "linked-lists", "all-pairs",
                                          "auto"};
  const std::vector<std::string>& calendars = calendar_names();
  const auto isas = kernels::available();
  scene.engine.search = searches[n % searches.size()];
  scene.engine.queue = calendars[n % 7 % calendars.size()];
  scene.engine.isa = kernels::name_of(isas[n % isas.size()]);
  scene.engine.storage = n % 3 == 0 ? "by-id" : "sorted";
  scene.engine.threads = 1;
  const bool parallel = scene.engine.search == "capsules" || scene.engine.search == "linked-cells";
  if (parallel && n % 2 == 1) {
    scene.engine.queue = "cell-calendar";
    scene = test::on_threads(scene, static_cast<int>(2 + n % 3));
  }
}

// A chain of checkpoints, each continued by other parts of the engine.
TEST(Checkpoint, ContinuesOnAnySearchCalendarThreadsAndInstructionSet) {
  for (const SavedScene& named : scenes()) {
    SCOPED_TRACE(named.name);
    test::Followed whole(named.scene);
    whole.advance_to_collision(collisions);
    Scene scene = named.scene;
    std::vector<Collision> seen;
    Checkpoint saved = Simulation(scene).checkpoint();
    const std::size_t parts = 35;
    for (std::size_t n = 1; n <= parts; ++n) {
      choose_parts(scene, n);
      SCOPED_TRACE(scene.engine.search + ", " + scene.engine.queue + ", " + scene.engine.isa);
      test::Followed part(scene, saved);
      EXPECT_EQ(part->initial_energy(), whole->initial_energy());
      part.collisions = seen;
      part.advance_to_collision(std::floor(collisions * static_cast<double>(n) / parts));
      saved = part.simulation.checkpoint();
      if (n == parts) {
        ASSERT_NO_FATAL_FAILURE(expect_same_end(whole.recorded(), part.recorded()));
      }
      seen = part.collisions;
    }
  }
}

// At times between collisions, and at those of window ends.
TEST(Checkpoint, ContinuesFromAnyTime) {
  for (const SavedScene& named : scenes()) {
    SCOPED_TRACE(named.name);
    test::Followed whole(named.scene);
    const double window = whole.simulation.epoch_length(), end = 7.3 * window;
    whole.simulation.advance(test::until_time(end));
    for (const double time : {0.1, 1.0, 2.0, 3.7}) {
      test::Followed first(named.scene);
      first.simulation.advance(test::until_time(time * window));
      test::Followed second(named.scene, first.simulation.checkpoint());
      EXPECT_EQ(second.simulation.time(), time * window);
      second.collisions = first.collisions;
      second.simulation.advance(test::until_time(end));
      ASSERT_NO_FATAL_FAILURE(expect_same_end(whole.recorded(), second.recorded())) << time;
    }
  }
}

// Needles that touch keep their sides: velocities are reversed just after a collision, which puts
// touches into records that no collision has made.
TEST(Checkpoint, KeepsTouches) {
  for (int n = 1; n < 60; ++n) {
    const Scene scene = test::scene_of(60, 3, 4);
    const auto start = [&](test::Followed& run) {
      run.advance_to_collision(n);
      test::reverse(run.simulation);
    };
    test::Followed whole(scene), first(scene);
    start(whole);
    whole.advance_to_collision(3 * n);
    start(first);
    test::Followed second(scene, first.simulation.checkpoint());
    second.collisions = first.collisions;
    second.advance_to_collision(3 * n);
    ASSERT_NO_FATAL_FAILURE(expect_same_end(whole.recorded(), second.recorded())) << n;
  }
}

TEST(Checkpoint, OfARestoredRunIsThatOfTheRun) {
  const Scene scene = scenes()[1].scene;
  test::Followed run(scene);
  run.advance_to_collision(500);
  const Checkpoint saved = run.simulation.checkpoint();
  EXPECT_EQ(Simulation(scene, saved).counters().events, run.simulation.counters().events);
  Scene by_id = scene;
  by_id.engine.storage = "by-id";
  // Counters of work may differ, sums and state may not.
  const Simulation again(by_id, saved);
  const State before = run.simulation.copy(), after = again.copy();
  EXPECT_EQ(before.position, after.position);
  EXPECT_EQ(before.image, after.image);
  EXPECT_EQ(before.id, after.id);
}

TEST(Checkpoint, OfOtherPhysicsIsRefused) {
  const Scene scene = scenes()[1].scene;
  const Checkpoint saved = Simulation(scene).checkpoint();
  const auto expect_refused = [&](auto change) {
    Scene other = scene;
    change(other);
    EXPECT_THROW(Simulation(other, saved), InputError);
  };
  expect_refused([](Scene& s) { s.collisions.epsilon = 0.81; });
  expect_refused([](Scene& s) { s.collisions.beta = 0; });
  expect_refused([](Scene& s) { s.collisions.tc_relative = 2e-2; });
  expect_refused([](Scene& s) { s.collisions.tc_relative = {}; });
  expect_refused([](Scene& s) { s.needles.k = 5; });
  expect_refused([](Scene& s) { s.needles.box[1] = 12; });
  expect_refused([](Scene& s) { s = test::with_species(s, 1, 2); });
  expect_refused([](Scene& s) { s.engine.accuracy = "rigorous"; });
  EXPECT_NO_THROW(Simulation(scene, saved));
}

TEST(Checkpoint, CutShortOrWithMoreBytesIsRefused) {
  Scene scene = test::scene_of(3, 3, 1);
  scene.collisions.tc = 1e-3;
  const Checkpoint saved = Simulation(scene).checkpoint();
  for (std::size_t size = 0; size < saved.bytes.size(); ++size) {
    ASSERT_THROW(Simulation(scene, Checkpoint{saved.bytes.substr(0, size)}), InputError) << size;
  }
  EXPECT_THROW(Simulation(scene, Checkpoint{saved.bytes + '\0'}), InputError);
}

// Found by fuzzing: the sum of the energies was then that of numbers beyond all integers.
TEST(Checkpoint, WithASquareThatOverflowsIsRefused) {
  const Scene scene = test::scene_of(3, 3, 1);
  const Simulation simulation(scene);
  const Checkpoint saved = simulation.checkpoint();
  const State state = simulation.copy();
  for (const double speed : {state.velocity[1][2], state.angular_velocity[1][2]}) {
    Checkpoint changed = saved;
    const std::string bytes(reinterpret_cast<const char*>(&speed), sizeof speed);
    const auto at = changed.bytes.find(bytes);
    ASSERT_NE(at, std::string::npos);
    const double large = 1e200;
    changed.bytes.replace(at, sizeof large, reinterpret_cast<const char*>(&large), sizeof large);
    EXPECT_THROW(Simulation(scene, changed), InputError);
  }
}

TEST(Checkpoint, OfNoNeedlesAndOfOneContinues) {
  for (const std::uint64_t count : {0, 1}) {
    const Scene scene = test::scene_of(count, 3, 1);
    Simulation run(scene);
    run.advance(test::until_time(2));
    Simulation again(scene, run.checkpoint());
    EXPECT_EQ(again.time(), 2);
    EXPECT_EQ(again.advance(test::until_time(5)), Stop::time);
    run.advance(test::until_time(5));
    EXPECT_EQ(again.copy().position, run.copy().position);
  }
}

}  // namespace
}  // namespace needlework
