// Every search gives the same events, bit for bit: all-pairs is the truth.
#include <gtest/gtest.h>

#include "tests/support/runs.h"

namespace needlework {
namespace {

struct Case {
  const char* name;
  std::uint64_t count;
  std::array<double, 3> box;
  double epsilon, beta, tc_relative, t_rot;
  double collisions;
};

class SearchEquivalence : public testing::TestWithParam<Case> {};

TEST_P(SearchEquivalence, LinkedCellsGiveTheEventsOfAllPairs) {
  const Case& c = GetParam();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Scene scene = test::scene_of(c.count, c.box[0], seed);
    scene.needles.box = c.box;
    scene.initial.t_rot = c.t_rot;
    scene.collisions.epsilon = c.epsilon;
    scene.collisions.beta = c.beta;
    if (c.tc_relative > 0) scene.collisions.tc_relative = c.tc_relative;
    scene.engine.search = "all-pairs";
    const test::Recorded truth = test::record(scene, c.collisions);
    scene.engine.search = "linked-cells";
    const test::Recorded cells = test::record(scene, c.collisions);
    ASSERT_EQ(truth.collisions.size(), cells.collisions.size());
    for (std::size_t n = 0; n < truth.collisions.size(); ++n) {
      const Collision &a = truth.collisions[n], &b = cells.collisions[n];
      ASSERT_TRUE(a.epoch == b.epoch && a.offset == b.offset && a.first == b.first &&
                  a.second == b.second && a.shift == b.shift && a.impulse == b.impulse)
          << test::name_of(scene) << ", collision " << n << ": " << a.first << "-" << a.second
          << " at " << a.time << " against " << b.first << "-" << b.second << " at " << b.time;
    }
    EXPECT_EQ(truth.hash, cells.hash) << test::name_of(scene);
    EXPECT_EQ(truth.end.position, cells.end.position);
    EXPECT_EQ(truth.end.velocity, cells.end.velocity);
    EXPECT_EQ(truth.end.orientation, cells.end.orientation);
    EXPECT_EQ(truth.end.angular_velocity, cells.end.angular_velocity);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SearchEquivalence,
    testing::Values(Case{"dilute", 300, {12, 12, 12}, 1, -1, 0, 1, 1000},
                    Case{"dense", 400, {3.2, 3.2, 3.2}, 1, -1, 0, 1, 600},
                    Case{"cooling", 300, {7, 7, 7}, 0.8, -1, 1e-3, 0, 2000},
                    Case{"strongly_cooling", 200, {6, 6, 6}, 0.4, -1, 1e-2, 1, 3000},
                    Case{"rough", 200, {6, 6, 6}, 0.9, 0.4, 1e-3, 1, 1000},
                    Case{"perfectly_rough", 200, {5, 5, 5}, 1, 1, 0, 1, 1000},
                    Case{"not_rotating", 100, {5, 5, 5}, 1, -1, 0, 0, 300},
                    Case{"least_box", 40, {2.01, 2.01, 2.01}, 1, -1, 0, 1, 600},
                    Case{"least_box_cooling", 60, {2.01, 2.02, 2.01}, 0.7, -1, 1e-3, 1, 1500},
                    Case{"flat_box", 200, {2.01, 9, 3.3}, 0.9, -1, 1e-3, 1, 800},
                    Case{"very_dilute", 30, {40, 40, 40}, 1, -1, 0, 1, 60},
                    Case{"two_needles", 2, {2.01, 2.01, 2.01}, 1, -1, 0, 1, 300}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace needlework
