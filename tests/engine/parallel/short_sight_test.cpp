// Events processed in the wrong order are detected and rolled back. To provoke them, these loops
// have a shorter sight for earlier events than usual.
#include <gtest/gtest.h>

#include "needlework/initial_state.h"
#include "src/engine/initial_gas.h"
#include "tests/support/parallel_loops.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

Scene::Until mean_collisions(double mean) {
  Scene::Until until;
  until.collisions_per_needle = mean;
  return until;
}

std::string hash_of_one_thread(const Scene& scene, const Scene::Until& until) {
  Simulation simulation(scene);
  simulation.advance(until);
  return simulation.trajectory_hash();
}

// The share of phases that were rolled back, on 2, 3 and 8 threads together: each run has only a
// few, one of which may be right by chance. The trajectory is right in any case.
double redone(const Scene& scene, const char* search, double sight, const Scene::Until& until) {
  const std::string truth = hash_of_one_thread(scene, until);
  double redone = 0, phases = 0;
  for (const int threads : {2, 3, 8}) {
    Run run(scene, make_gas(scene, draw_initial_state(scene)));
    const auto loop = test::parallel_loop(run, search, threads, {.sight = sight, .by_cost = false});
    EXPECT_EQ(loop->advance(StopConditions(run, until)), Stop::collisions);
    EXPECT_EQ(run.tally.hash.hex(), truth) << threads << " threads";
    redone += static_cast<double>(run.tally.counters.redone);
    phases += static_cast<double>(run.tally.counters.phases);
  }
  return redone / phases;
}

TEST(ParallelOutOfOrder, IsRolledBackWithoutSight) {
  const Scene::Until until = mean_collisions(4);
  EXPECT_GT(redone(test::scene_of(2000, 14, 3), "linked-cells", 0, until), 0.5);
  EXPECT_GT(redone(test::scene_of(2000, 5, 3), "capsules", 0, until), 0.7);
}

// With this sight fewer collisions are out of order, but some must be.
TEST(ParallelOutOfOrder, IsDetectedWithShortSight) {
  EXPECT_GT(redone(test::scene_of(2000, 5, 3), "capsules", 0.2, mean_collisions(12)), 0);
}

}  // namespace
}  // namespace needlework
