// Every calendar gives the same events, bit for bit, through sorting of the storage and a mean free
// time that grows; and so does every order of storage.
#include <gtest/gtest.h>

#include "src/calendar/all.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

template <Calendar C>
class CalendarEquivalence : public testing::Test {};
TYPED_TEST_SUITE(CalendarEquivalence, AllCalendars<testing::Types>);

TYPED_TEST(CalendarEquivalence, GivesTheSameEvents) {
  for (const double epsilon : {1.0, 0.5}) {
    Scene scene = test::scene_of(300, 6, 4);
    scene.collisions.epsilon = epsilon;
    if (epsilon < 1) scene.collisions.tc_relative = 1e-2;
    scene.engine.queue = LazyHeap::name;
    const test::Recorded plain = test::record(scene, 8000);
    scene.engine.queue = TypeParam::name;
    Simulation simulation(scene);
    EXPECT_STREQ(simulation.queue().c_str(), TypeParam::name);
    simulation.advance(test::until_collisions(2 * 8000 / 300.0));
    EXPECT_EQ(simulation.trajectory_hash(), plain.hash) << "epsilon " << epsilon;
    EXPECT_GT(simulation.counters().sorts, 0u);
  }
}

// Neither the order in which needles are stored, nor the times at which it is updated, changes any
// bit.
TEST(StorageEquivalence, OrderOfStorageChangesNothing) {
  Scene scene = test::scene_of(300, 6, 4);
  const test::Recorded sorted = test::record(scene, 6000);
  scene.engine.storage = "by-id";
  const test::Recorded by_id = test::record(scene, 6000);
  EXPECT_EQ(by_id.hash, sorted.hash);
  Simulation one(scene);
  one.advance({.time = {}, .collisions_per_needle = 40, .energy_ratio = {}, .wall_s = {}});
  EXPECT_EQ(one.counters().sorts, 0u);
  scene.engine.storage = "sorted";
  Simulation two(scene);
  two.advance({.time = {}, .collisions_per_needle = 40, .energy_ratio = {}, .wall_s = {}});
  EXPECT_GT(two.counters().sorts, 0u);
}

}  // namespace
}  // namespace needlework
