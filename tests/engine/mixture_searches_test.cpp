// Searches of mixtures: whatever the lengths, the trajectory is that of all pairs, on any number of
// threads.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

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
                                         TwoLengths{"one_to_four_dilute", 640, 160, 4, 0.1, 1},
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

// Bodies of very different widths: how near two of them may come is looked up for each two.
struct Widths {
  const char* name;
  double box;
  Species small, big;
};

void PrintTo(const Widths& c, std::ostream* out) { *out << c.name; }

Species body(const char* name, std::uint64_t count, double length, double diameter, double mass) {
  return {.name = name,
          .count = count,
          .length = length,
          .mass = mass,
          .k = diameter > 0 && length > 0 ? homogeneous_k(length, diameter) : 6,
          .diameter = diameter};
}

Scene scene_of(const Widths& c) {
  Scene scene;
  scene.needles.box = {c.box, c.box, c.box};
  scene.species = {c.small, c.big};
  return scene;
}

class MixtureOfWidths : public testing::TestWithParam<Widths> {};

TEST_P(MixtureOfWidths, HasOneTrajectoryBySearch) {
  Scene scene = scene_of(GetParam());
  const auto hash_by = [&](const char* search) {
    scene.engine.search = search;
    Simulation simulation(scene);
    simulation.advance(test::until_collisions(3));
    return simulation.trajectory_hash();
  };
  const std::string truth = hash_by("all-pairs");
  for (const char* search : {"linked-cells", "capsules", "auto"}) {
    EXPECT_EQ(hash_by(search), truth) << search;
  }
  scene.engine.threads = 2;
  scene.engine.team = "all";
  EXPECT_EQ(hash_by("auto"), truth);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, MixtureOfWidths,
    testing::Values(
        Widths{"one_big_sphere", 21, body("small", 400, 0, 0.5, 1), body("big", 1, 0, 10, 100)},
        Widths{"few_big_spheres", 8, body("small", 500, 0, 0.4, 1), body("big", 8, 0, 2, 30)},
        Widths{"dense_spheres", 5, body("small", 400, 0, 0.5, 1), body("big", 16, 0, 1.5, 20)},
        Widths{"spheres_alike", 4, body("small", 100, 0, 0.5, 1), body("big", 60, 0, 0.8, 2)},
        Widths{"rods_and_spheres", 9, body("small", 200, 2, 0.1, 1), body("big", 20, 0, 2, 5)},
        Widths{"rods", 13, body("small", 300, 1, 0.1, 1), body("big", 20, 5, 1, 10)}),
    [](const auto& info) { return std::string(info.param.name); });

// What a collision costs, and how many events there are, without clocks.
struct Work {
  double candidates, evaluated, searches;
};

Work work_of(const Scene& scene) {
  Simulation simulation(scene);
  simulation.advance(test::until_collisions(1));
  const auto from = simulation.counters();
  const auto before = static_cast<double>(simulation.collisions());
  simulation.advance(test::until_collisions(4));
  const Counters to = simulation.counters();
  const double collisions = static_cast<double>(simulation.collisions()) - before;
  const auto each = [&](std::uint64_t a, std::uint64_t b) {
    return static_cast<double>(b - a) / collisions;
  };
  return {each(from.candidates, to.candidates), each(from.evaluated, to.evaluated),
          each(from.searches, to.searches)};
}

TEST(MixtureSearches, OneBigBodyCostsLittle) {
  const Species small = body("small", 2000, 0, 0.5, 1);
  const Work alone = work_of(scene_of({"", 21, small, body("none", 0, 0, 10, 100)}));
  for (const double diameter : {2.5, 5.0, 10.0}) {
    const Work with_one = work_of(scene_of({"", 21, small, body("big", 1, 0, diameter, 100)}));
    EXPECT_LT(with_one.candidates, 2 * alone.candidates) << diameter;
    EXPECT_LT(with_one.evaluated, 3 * alone.evaluated) << diameter;
    EXPECT_LT(with_one.searches, 1.5 * alone.searches) << diameter;
  }
}

// Neither the trajectory nor the work depends on species of which there are none.
TEST(MixtureSearches, EmptySpeciesCostNothing) {
  std::vector<Scene> scenes;
  for (const Species& alone : {body("a", 500, 1, 0, 1), body("a", 500, 2, 0, 3),
                               body("a", 500, 0, 0.5, 1), body("a", 300, 1, 0.2, 1)}) {
    Scene& scene = scenes.emplace_back(test::scene_of(0, 7, 5));
    scene.species = {alone};
    scene.collisions.epsilon = 0.9;
    scene.collisions.tc_relative = 1e-3;
  }
  for (Scene scene : scenes) {
    const auto until = test::until_collisions(5);
    Simulation alone(scene);
    alone.advance(until);
    const bool wide = scene.species[0].diameter > 0;
    const Species none = body("none", 0, wide ? 0 : 3, wide ? 3 : 0, 0.01);
    for (const bool first : {true, false}) {
      scene.species.insert(first ? scene.species.begin() : scene.species.end(), none);
      if (!first) scene.species.back().name = "other";
      Simulation with_empty(scene);
      with_empty.advance(until);
      EXPECT_EQ(with_empty.trajectory_hash(), alone.trajectory_hash());
      EXPECT_EQ(with_empty.counters().candidates, alone.counters().candidates);
      EXPECT_EQ(with_empty.counters().bracket_steps, alone.counters().bracket_steps);
      EXPECT_EQ(with_empty.collisions_by_pair()[first ? 2 : 3], alone.collisions());
    }
  }
}

}  // namespace
}  // namespace needlework
