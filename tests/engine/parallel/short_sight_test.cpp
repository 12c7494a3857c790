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

// Number of phases that were rolled back. The trajectory is right in any case.
std::uint64_t redone(const Scene& scene, const char* search, int threads, double sight,
                     const Scene::Until& until, const std::string& truth) {
  Run run(scene, make_gas(scene, draw_initial_state(scene)));
  const auto loop =
      test::make_parallel_loop<Effects{}>(run, search, threads, {.sight = sight, .by_cost = false});
  EXPECT_EQ(loop->advance(Limits(run, until)), Stop::collisions);
  EXPECT_EQ(run.tally.hash.hex(), truth) << threads << " threads";
  return run.tally.counters.redone;
}

std::string hash_of_one_thread(const Scene& scene, const Scene::Until& until) {
  Simulation simulation(scene);
  simulation.advance(until);
  return simulation.trajectory_hash();
}

TEST(ParallelOutOfOrder, IsRolledBackWithoutSight) {
  // A run has only a few phases, and on a busy machine threads may take turns by chance, so the
  // number is not certain; but hardly any phase is right.
  const Scene::Until until = mean_collisions(4);
  const Scene dilute = test::scene_of(2000, 14, 3), dense = test::scene_of(2000, 5, 3);
  const std::string of_dilute = hash_of_one_thread(dilute, until);
  const std::string of_dense = hash_of_one_thread(dense, until);
  for (const int threads : {2, 3, 8}) {
    EXPECT_GT(redone(dilute, "linked-cells", threads, 0, until, of_dilute), 0u);
    EXPECT_GT(redone(dense, "capsules", threads, 0, until, of_dense), 0u);
  }
}

// With this sight fewer collisions are out of order, but some must be.
TEST(ParallelOutOfOrder, IsDetectedWithShortSight) {
  const Scene::Until until = mean_collisions(12);
  const Scene scene = test::scene_of(2000, 5, 3);
  const std::string truth = hash_of_one_thread(scene, until);
  std::uint64_t all = 0;
  for (const int threads : {2, 3, 8}) {
    all += redone(scene, "capsules", threads, 0.2, until, truth);
  }
  EXPECT_GT(all, 0u);
}

}  // namespace
}  // namespace needlework
