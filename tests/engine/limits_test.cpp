// Runs that have come near the largest time, count or number of boxes go on as younger ones, or end
// with an error that says why.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/calendar/names.h"
#include "tests/support/runs.h"
#include "tests/support/saved_gas.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::SavedGas;

constexpr double half_way = 300, end = 900;  // collisions

Scene cooling() {
  Scene scene = test::scene_of(150, 5, 7);
  scene.collisions = {.epsilon = 0.8, .beta = 0.2, .tc = {}, .tc_relative = 1e-2};
  return scene;
}

struct Engine {
  std::string search, queue;
  int threads;
};

std::vector<Engine> engines() {
  std::vector<Engine> all;
  const std::string searches[] = {"capsules", "linked-cells", "linked-lists", "all-pairs"};
  for (const std::string& calendar : calendar_names()) {
    all.push_back({searches[all.size() % std::size(searches)], calendar, 1});
  }
  all.push_back({"capsules", "cell-calendar", 2});
  all.push_back({"linked-cells", "cell-calendar", 3});
  return all;
}

Scene with(Scene scene, const Engine& engine) {
  scene.engine.search = engine.search;
  scene.engine.queue = engine.queue;
  scene.engine.threads = engine.threads;
  return scene;
}

std::string name_of(const Engine& engine) {
  return engine.search + ", " + engine.queue + ", " + std::to_string(engine.threads) + " threads";
}

void advance_to(Simulation& simulation, double collisions) {
  simulation.advance(
      test::until_collisions(2 * collisions / static_cast<double>(simulation.needles())));
}

// The middle of a run.
SavedGas middle() {
  Simulation simulation(cooling());
  advance_to(simulation, half_way);
  return SavedGas(cooling(), simulation.checkpoint());
}

std::vector<Collision> second_half(const Engine& engine, SavedGas from) {
  test::Followed run(with(cooling(), engine), from.checkpoint());
  const auto wanted = static_cast<std::size_t>(end - half_way);
  while (run.collisions.size() < wanted) {
    run->advance(test::until_time(run->time() + 0.2 * run->epoch_length()));
  }
  run.collisions.resize(wanted);
  return run.collisions;
}

// In a number of collisions, as times of so long a run have no digits for the small steps.
std::vector<Collision> second_half_by_collisions(const Engine& engine, SavedGas from) {
  test::Followed run(with(cooling(), engine), from.checkpoint());
  advance_to(*run, end);
  return run.collisions;
}

void expect_same(const std::vector<Collision>& a, const std::vector<Collision>& b,
                 std::int64_t epochs) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    ASSERT_EQ(a[n].epoch + epochs, b[n].epoch) << n;
    ASSERT_EQ(a[n].offset, b[n].offset) << n;
    ASSERT_EQ(a[n].first, b[n].first) << n;
    ASSERT_EQ(a[n].second, b[n].second) << n;
    ASSERT_EQ(a[n].impulse, b[n].impulse) << n;
    ASSERT_EQ(a[n].contact_time_rule, b[n].contact_time_rule) << n;
  }
}

TEST(LongRuns, HaveTheSameCollisionsAtAnyTime) {
  const auto young = second_half_by_collisions(engines()[0], middle());
  for (const std::int64_t epochs :
       {std::int64_t{1} << 32, (std::int64_t{1} << 53) + 1, std::int64_t{1} << 61}) {
    SavedGas old = middle();
    old.for_each_time([&](Time& time) { time.epoch += epochs; });
    for (const Engine& engine : engines()) {
      SCOPED_TRACE(name_of(engine) + ", " + std::to_string(epochs) + " epochs");
      ASSERT_NO_FATAL_FAILURE(expect_same(young, second_half_by_collisions(engine, old), epochs));
    }
  }
}

// Without a limit, the last event would be followed by nothing.
TEST(LongRuns, EndWithAnErrorAtTheEndOfTheClock) {
  for (const Engine& engine : engines()) {
    SCOPED_TRACE(name_of(engine));
    SavedGas old = middle();
    const std::int64_t epochs = Time::never().epoch - 3 - old.now.epoch;
    old.for_each_time([&](Time& time) {
      time.epoch += epochs;
      if (time >= Time::never()) time = Time::never();
    });
    Simulation simulation(with(cooling(), engine), old.checkpoint());
    try {
      simulation.advance(test::until_collisions(1e9));
      FAIL() << "no error";
    } catch (const InvalidStateError& error) {
      EXPECT_NE(std::string(error.what()).find("the largest time of this run"), std::string::npos)
          << error.what();
    }
    EXPECT_GT(simulation.collisions(), half_way);
    // The state is sound: it can be saved, and fails again in the same way.
    Simulation again(cooling(), simulation.checkpoint());
    EXPECT_THROW(again.advance(test::until_collisions(1e9)), InvalidStateError);
  }
}

TEST(LongRuns, CountCollisionsBeyond32And53Bits) {
  const auto young = second_half(engines()[0], middle());
  for (const std::uint64_t before :
       {(std::uint64_t{1} << 32) - 400, (std::uint64_t{1} << 53) - 400, (std::uint64_t{1} << 62)}) {
    SavedGas old = middle();
    old.tally.collisions += before;
    for (const Counters::Named& counter : Counters::all) {
      old.tally.counters.*counter.value += ~std::uint64_t{0} - 100000;
    }
    for (const Engine& engine : engines()) {
      SCOPED_TRACE(name_of(engine) + ", " + std::to_string(before));
      ASSERT_NO_FATAL_FAILURE(expect_same(young, second_half(engine, old), 0));
    }
    Simulation simulation(cooling(), old.checkpoint());
    simulation.advance(test::until_time(simulation.time() + 2 * simulation.epoch_length()));
    const std::uint64_t more = simulation.collisions() - before;
    EXPECT_GT(more, half_way);
    EXPECT_LT(more, 10 * end);
    EXPECT_EQ(simulation.totals().collisions, simulation.collisions());
  }
}

// Numbers of records and sums of energies are modulo powers of two.
TEST(LongRuns, DoNotDependOnNumbersThatWrapAround) {
  const auto young = second_half_by_collisions(engines()[0], middle());
  SavedGas old = middle();
  for (test::SavedNeedle& needle : old.needles) {
    needle.serial -= 8;  // below 0 for most
    for (RecordedTouch& touch : needle.touches) touch.partner_serial -= 8;
  }
  Quanta most = Quanta::nearest(0x1p126);
  most += most;
  most -= Quanta::nearest(1);
  old.quanta_at_window += most;
  old.tally.energy += most;
  for (const Engine& engine : engines()) {
    SCOPED_TRACE(name_of(engine));
    ASSERT_NO_FATAL_FAILURE(expect_same(young, second_half_by_collisions(engine, old), 0));
  }
  Simulation simulation(cooling(), old.checkpoint());
  advance_to(simulation, end);
  EXPECT_GT(simulation.totals().energy, 0);
}

TEST(LongRuns, EndWithAnErrorWhenANeedleHasCrossedTooManyBoxes) {
  for (const Engine& engine : engines()) {
    SCOPED_TRACE(name_of(engine));
    SavedGas old = middle();
    for (test::SavedNeedle& needle : old.needles) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto& v = needle.flight.v;
        const double along = axis == 0 ? v.x : axis == 1 ? v.y : v.z;
        needle.image[axis] = along > 0 ? most_boxes : -most_boxes;
      }
    }
    Simulation simulation(with(cooling(), engine), old.checkpoint());
    EXPECT_THROW(
        {
          advance_to(simulation, 1e5);
          simulation.copy();
        },
        InvalidStateError);
  }
}

// A gas that cools for many windows loses more quanta than 64 bits hold.
TEST(LongRuns, FollowTheEnergyOverManyDecades) {
  Scene scene = test::inelastic(test::scene_of(60, 4, 3), 0.5, 1e-2);
  Simulation simulation(scene);
  Scene::Until until;
  until.energy_ratio = 1e-30;
  EXPECT_EQ(simulation.advance(until), Stop::energy);
  const double ratio = simulation.totals().energy / simulation.initial_energy();
  EXPECT_LE(ratio, 1e-30 * (1 + 1e-9));
  EXPECT_GT(ratio, 1e-31);
  // There, the clock has run out.
  until.energy_ratio = 1e-60;
  EXPECT_THROW(simulation.advance(until), InvalidStateError);
  EXPECT_LT(simulation.totals().energy / simulation.initial_energy(), 1e-32);
}

}  // namespace
}  // namespace needlework
