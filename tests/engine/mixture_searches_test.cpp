// Searches of mixtures: whatever the lengths, the trajectory is that of all pairs, on any number of
// threads.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

struct Case {
  std::string name;
  Scene scene;
  double collisions;     ///< per needle
  bool is_rare = false;  ///< collisions, which are left to one thread
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// Short needles of length 1, and long ones; so many to the cube of the mean length.
Case lengths(const char* name, double short_ones, double long_ones, double length, double density,
             double collisions) {
  const double count = short_ones + long_ones, mean = (short_ones + long_ones * length) / count;
  const double box = std::cbrt(count / density) * mean;
  Scene scene = test::inelastic(test::scene_of(0, box, 11), 0.95);
  scene.needles.box = {box, 1.02 * box, box / 1.02};
  scene.species = {
      {.name = "short", .count = std::uint64_t(short_ones), .length = 1},
      {.name = "long", .count = std::uint64_t(long_ones), .length = length, .mass = 3, .k = 5}};
  return {name, scene, collisions, density < 1};
}

Species body(const char* name, std::uint64_t count, double length, double diameter, double mass) {
  return {.name = name,
          .count = count,
          .length = length,
          .mass = mass,
          .k = diameter > 0 && length > 0 ? homogeneous_k(length, diameter) : 6,
          .diameter = diameter};
}

/// Bodies of very different widths: how near two of them may come is looked up for each two.
Case widths(const char* name, double box, const Species& small, const Species& big) {
  Scene scene = test::scene_of(0, box);
  scene.species = {small, big};
  return {name, scene, 3, true};
}

class MixtureSearches : public testing::TestWithParam<Case> {};

TEST_P(MixtureSearches, GiveOneTrajectory) {
  const Case& c = GetParam();
  Scene scene = c.scene;
  const auto until = test::until_collisions(c.collisions);
  // All pairs of many needles take too long.
  const bool few = scene.species[0].count + scene.species[1].count < 2000;
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
  for (const auto& [search, threads] : {std::pair("linked-cells", 2), {"capsules", 3}}) {
    scene = test::on_threads(test::searched_by(scene, search), threads);
    const std::uint64_t phases = expect_the_same();
    if (!c.is_rare) {
      EXPECT_GT(phases, 0u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, MixtureSearches,
    testing::Values(
        lengths("equal_lengths", 300, 300, 1, 1, 4), lengths("in_one_class", 300, 300, 1.4, 1, 4),
        lengths("half_and_half", 400, 400, 20, 1, 4),
        lengths("one_to_four_dilute", 640, 160, 4, 0.1, 1),
        lengths("one_to_four", 640, 160, 4, 1, 4),
        lengths("one_to_four_dense_long", 400, 400, 4, 10, 4),
        lengths("one_to_twenty_dilute", 640, 160, 20, 0.1, 2),
        lengths("one_to_twenty_long", 640, 160, 20, 1, 4),
        lengths("one_to_twenty_dense_long", 400, 400, 20, 10, 4),
        lengths("few_long_ones_dilute", 700, 30, 20, 0.05, 1),
        lengths("few_long_ones", 3000, 150, 20, 0.225, 0.1),
        lengths("few_short_ones", 10, 700, 20, 3, 4),
        widths("one_big_sphere", 21, body("small", 400, 0, 0.5, 1), body("big", 1, 0, 10, 100)),
        widths("few_big_spheres", 8, body("small", 500, 0, 0.4, 1), body("big", 8, 0, 2, 30)),
        widths("dense_spheres", 5, body("small", 400, 0, 0.5, 1), body("big", 16, 0, 1.5, 20)),
        widths("spheres_alike", 4, body("small", 100, 0, 0.5, 1), body("big", 60, 0, 0.8, 2)),
        widths("rods_and_spheres", 9, body("small", 200, 2, 0.1, 1), body("big", 20, 0, 2, 5)),
        widths("rods", 13, body("small", 300, 1, 0.1, 1), body("big", 20, 5, 1, 10))),
    [](const auto& info) { return info.param.name; });

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
  const Work alone = work_of(widths("", 21, small, body("none", 0, 0, 10, 100)).scene);
  for (const double diameter : {2.5, 5.0, 10.0}) {
    const Work with_one = work_of(widths("", 21, small, body("big", 1, 0, diameter, 100)).scene);
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
