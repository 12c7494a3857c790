// Searches of mixtures: whatever the lengths, the trajectory is that of all pairs, on any number of
// threads.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <utility>

#include "tests/support/runs.h"

namespace needlework {
namespace {

/// Short needles of length 1, and long ones.
struct TwoLengths {
  const char* name;
  std::uint64_t short_ones, long_ones;
  double length;   ///< of the long ones
  double density;  ///< needles per cube of the mean length
  double collisions;
};

void PrintTo(const TwoLengths& c, std::ostream* out) { *out << c.name; }

Scene scene_of(const TwoLengths& c) {
  const double count = static_cast<double>(c.short_ones + c.long_ones);
  const double mean =
      (static_cast<double>(c.short_ones) + static_cast<double>(c.long_ones) * c.length) / count;
  const double box = std::cbrt(count / c.density) * mean;
  Scene scene = test::scene_of(0, box, 11);
  scene.needles.box = {box, 1.02 * box, box / 1.02};
  scene.species = {{.name = "short", .count = c.short_ones, .length = 1, .mass = 1, .k = 6},
                   {.name = "long", .count = c.long_ones, .length = c.length, .mass = 3, .k = 5}};
  scene.collisions.epsilon = 0.95;
  scene.collisions.tc_relative = 1e-3;
  return scene;
}

class MixtureSearches : public testing::TestWithParam<TwoLengths> {};

TEST_P(MixtureSearches, GiveOneTrajectory) {
  const TwoLengths& c = GetParam();
  Scene scene = scene_of(c);
  const auto until = test::until_collisions(c.collisions);
  // All pairs of many needles take too long.
  const bool few = c.short_ones + c.long_ones < 2000;
  scene.engine.search = few ? "all-pairs" : "linked-lists";
  Simulation first(scene);
  first.advance(until);
  const auto expect_the_same = [&] {
    Simulation simulation(scene);
    simulation.advance(until);
    EXPECT_EQ(simulation.trajectory_hash(), first.trajectory_hash())
        << scene.engine.search << " on " << scene.engine.threads.value_or(1);
    EXPECT_EQ(simulation.collisions_by_pair(), first.collisions_by_pair());
    return simulation.counters().phases;
  };
  const std::string truth = scene.engine.search;
  for (const char* search : {"linked-lists", "linked-cells", "capsules", "auto"}) {
    scene.engine.search = search;
    if (search != truth) expect_the_same();
  }
  scene.engine.team = "all";
  for (const auto& [search, threads] : {std::pair("linked-cells", 2), {"capsules", 3}}) {
    scene.engine.search = search;
    scene.engine.threads = threads;
    const std::uint64_t phases = expect_the_same();
    // Rare collisions are left to one thread.
    if (c.density >= 1) {
      EXPECT_GT(phases, 0u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, MixtureSearches,
                         testing::Values(TwoLengths{"equal_lengths", 300, 300, 1, 1, 4},
                                         TwoLengths{"in_one_class", 300, 300, 1.4, 1, 4},
                                         TwoLengths{"half_and_half", 400, 400, 20, 1, 4},
                                         TwoLengths{"one_to_four_dilute", 640, 160, 4, 0.1, 2},
                                         TwoLengths{"one_to_four", 640, 160, 4, 1, 4},
                                         TwoLengths{"one_to_four_dense_long", 400, 400, 4, 10, 4},
                                         TwoLengths{"one_to_twenty_dilute", 640, 160, 20, 0.1, 2},
                                         TwoLengths{"one_to_twenty_long", 640, 160, 20, 1, 4},
                                         TwoLengths{"one_to_twenty_dense_long", 400, 400, 20, 10,
                                                    4},
                                         TwoLengths{"few_long_ones_dilute", 700, 30, 20, 0.05, 1},
                                         TwoLengths{"few_long_ones", 3000, 150, 20, 0.225, 0.1},
                                         TwoLengths{"few_short_ones", 10, 700, 20, 3, 4}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace needlework
