// Every search on every instruction set gives the same events, bit for bit. All-pairs is the
// reference.
#include <gtest/gtest.h>

#include "tests/support/same_run.h"
#include "tests/support/searches.h"

namespace needlework {
namespace {

using test::thin;

struct Case {
  const char* name;
  std::uint64_t count;
  std::array<double, 3> box;
  double epsilon, beta, tc_relative, t_rot;
  double collisions;
  double energy = 10;  ///< per needle, at which the run ends
};

class SearchEquivalence : public testing::TestWithParam<Case> {};

TEST_P(SearchEquivalence, GivesThoseOfAllPairs) {
  const Case& c = GetParam();
  const double count = c.collisions / thin;
  const std::vector<test::SearchChoice> choices = test::search_choices();
  constexpr std::size_t seeds = 3;  // each search runs on one of them
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    Scene scene = test::scene_of(c.count, c.box[0], seed + 1);
    scene.needles.box = c.box;
    scene.initial.t_rot = c.t_rot;
    scene.collisions.epsilon = c.epsilon;
    scene.collisions.beta = c.beta;
    if (c.tc_relative > 0) scene.collisions.tc_relative = c.tc_relative;
    choices[0].apply(scene);
    const test::Recorded truth = test::record(scene, count);
    ASSERT_GE(static_cast<double>(truth.collisions.size()), count);
    if (thin == 1) {
      EXPECT_LT(truth.totals.energy, c.energy);
    }
    for (std::size_t n = 1 + seed; n < choices.size(); n += seeds) {
      SCOPED_TRACE(choices[n].name() + ", " + test::name_of(scene));
      choices[n].apply(scene);
      ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, test::record(scene, count)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SearchEquivalence,
    testing::Values(Case{"dilute", 300, {12, 12, 12}, 1, -1, 0, 1, 600},
                    Case{"dense", 400, {3.2, 3.2, 3.2}, 1, -1, 0, 1, 600},
                    Case{"very_dense_long", 300, {2.01, 2.01, 2.01}, 1, -1, 0, 1, 600},
                    Case{"cooling", 300, {7, 7, 7}, 0.8, -1, 1e-3, 0, 1500},
                    Case{"strongly_cooling_long", 200, {6, 6, 6}, 0.4, -1, 1e-2, 1, 3000},
                    Case{"cooling_by_decades_long", 40, {4, 4, 4}, 0.5, -1, 3e-2, 1, 3000, 5e-2},
                    Case{"rough", 200, {6, 6, 6}, 0.9, 0.4, 1e-3, 1, 1000},
                    Case{"perfectly_rough", 200, {5, 5, 5}, 1, 1, 0, 1, 1000},
                    Case{"not_rotating", 100, {5, 5, 5}, 1, -1, 0, 0, 300},
                    Case{"least_box", 40, {2.01, 2.01, 2.01}, 1, -1, 0, 1, 600},
                    Case{"least_box_cooling", 60, {2.01, 2.02, 2.01}, 0.7, -1, 1e-3, 1, 1500},
                    Case{"flat_box", 200, {2.01, 9, 3.3}, 0.9, -1, 1e-3, 1, 800},
                    Case{"very_dilute_long", 30, {20, 20, 20}, 1, -1, 0, 1, 30},
                    Case{"two_needles", 2, {2.01, 2.01, 2.01}, 1, -1, 0, 1, 300}),
    [](const auto& info) { return std::string(info.param.name); });

// If bounding volumes hid a needle from another, it would show about once in a thousand
// collisions. They extend farthest beyond their cells in dilute gases.
TEST(SearchEquivalence, HoldsForManyNeedlesOverManyCollisions_long) {
  for (const double box : {100.0, 46.0, 14.0, 5.57}) {
    Scene scene = test::scene_of(2000, box, 1);
    SCOPED_TRACE(test::name_of(scene));
    const double count = 20000 / thin;
    scene.engine.search = "linked-lists";
    const test::Recorded truth = test::record(scene, count);
    for (const char* search : {"linked-cells", "capsules"}) {
      SCOPED_TRACE(search);
      scene.engine.search = search;
      ASSERT_NO_FATAL_FAILURE(test::expect_same(truth, test::record(scene, count)));
    }
  }
}

}  // namespace
}  // namespace needlework
