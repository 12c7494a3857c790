// Events processed in the wrong order are detected and rolled back. To provoke them, these loops
// have a shorter sight for earlier events than usual.
#include <gtest/gtest.h>

#include "needlework/initial_state.h"
#include "tests/support/parallel_loops.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

Scene::Until mean_collisions(double mean) {
  Scene::Until until;
  until.collisions_per_needle = mean;
  return until;
}

// How many of the phases were rolled back. The trajectory is right in any case.
double redone(const Scene& scene, const char* search, int threads, double sight,
              const Scene::Until& until, const std::string& truth) {
  Run run(scene, make_gas(scene, draw_initial_state(scene)));
  const auto loop =
      test::make_parallel_loop<Effects{}>(run, search, threads, {.sight = sight, .by_cost = false});
  EXPECT_EQ(loop->advance(Limits(run, until)), Stop::collisions);
  const Tally& tally = run.tally;
  EXPECT_EQ(tally.hash.hex(), truth) << threads << " threads";
  return static_cast<double>(tally.counters.redone) / static_cast<double>(tally.counters.phases);
}

std::string hash_of_one_thread(const Scene& scene, const Scene::Until& until) {
  Simulation simulation(scene);
  simulation.advance(until);
  return simulation.trajectory_hash();
}

TEST(ParallelOutOfOrder, IsRolledBackWithoutSight) {
  const Scene::Until until = mean_collisions(4);
  const Scene dilute = test::scene_of(2000, 14, 3), dense = test::scene_of(2000, 5, 3);
  const std::string of_dilute = hash_of_one_thread(dilute, until);
  const std::string of_dense = hash_of_one_thread(dense, until);
  for (const int threads : {2, 3, 8}) {
    EXPECT_GT(redone(dilute, "linked-cells", threads, 0, until, of_dilute), 0.5);
    EXPECT_GT(redone(dense, "capsules", threads, 0, until, of_dense), 0.7);
  }
}

// With this sight few phases are rolled back, but some must be.
TEST(ParallelOutOfOrder, IsDetectedWithShortSight) {
  const Scene::Until until = mean_collisions(12);
  const Scene scene = test::scene_of(2000, 5, 3);
  const std::string truth = hash_of_one_thread(scene, until);
  double all = 0;
  for (const int threads : {2, 3, 8}) {
    all += redone(scene, "capsules", threads, 0.2, until, truth);
  }
  EXPECT_GT(all, 0);
}

}  // namespace
}  // namespace needlework
