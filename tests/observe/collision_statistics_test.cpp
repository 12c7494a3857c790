// Statistics of collisions that are known, and of a gas in equilibrium.
#include <cmath>
#include <numbers>

#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

const Vector box{5, 5, 5};

Collision collision_of(std::uint32_t first, std::uint32_t second) {
  Collision c;
  c.first = first;
  c.second = second;
  c.arm_first = 0.25;
  c.arm_second = -0.45;
  c.sin_angle = 0.8;
  c.after[0].orientation = {0, 0, 1};
  c.after[1].orientation = {0.8, 0, -0.6};
  c.normal_velocity = -2;
  return c;
}

TEST(CollisionStatistics, FollowChainsOfPairs) {
  Observed observed(scene_with("collision_statistics", 4, box));
  observed.sample(resting(4, box));
  // Three of (0, 1), one of which (1, 2) ends; (2, 3) ends that; (0, 1) begins anew, as 1 has
  // been elsewhere.
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 1}, {0, 1}, {1, 2}, {2, 3}, {0, 1}}) {
    observed.collision(collision_of(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)));
  }
  Values values = observed.sample(resting(4, box));
  EXPECT_EQ(values["collisions"][0], 6);
  EXPECT_EQ(values["repeats"][0], 2);
  EXPECT_EQ(values["chains"][0], 1) << "(1, 2)";
  EXPECT_EQ(values["chains"][2], 1) << "(0, 1)";
  EXPECT_EQ(sum(values["chains"]), 2) << "two are not finished";

  // A chain goes on across samples, in which counts begin at 0.
  observed.collision(collision_of(0, 1));
  observed.collision(collision_of(0, 3));
  values = observed.sample(resting(4, box));
  EXPECT_EQ(values["collisions"][0], 2);
  EXPECT_EQ(values["repeats"][0], 1);
  EXPECT_EQ(values["chains"][0], 1) << "(2, 3)";
  EXPECT_EQ(values["chains"][1], 1) << "(0, 1)";
}

TEST(CollisionStatistics, CountContacts) {
  Observed observed(scene_with("collision_statistics", 2, box));
  State state = resting(2, box);
  for (Vector& v : state.velocity) v = {1, 1, 1};  // T_tr = 1, T_rot = 0: sigma = sqrt(2)
  observed.sample(state);
  observed.collision(collision_of(0, 1));
  Values values = observed.sample(state);
  EXPECT_EQ(values["arms"][37], 1) << "0.25";
  EXPECT_EQ(values["arms"][2], 1) << "-0.45";
  EXPECT_EQ(sum(values["arms"]), 2);
  const double angle = std::acos(-0.6);
  EXPECT_EQ(values["angle"][static_cast<std::size_t>(angle / std::numbers::pi * 45)], 1);
  EXPECT_EQ(values["normal_velocity"][14], 1) << std::sqrt(2.0);
  EXPECT_EQ(sum(observed.sample(state)["arms"]), 0);
}

// In equilibrium <x^2> = 2 with variance 4, and <sin^2> of the angle is 3/4 with variance 1/16.
// Repeats of a pair are correlated, so errors are allowed to be some times those of counts.
TEST(CollisionStatistics, OfAGasInEquilibriumFollowItsLaws) {
  Scene scene = test::scene_of(2000, 14, 4);
  scene.output.observables = {"collision_statistics"};
  Simulation simulation(scene);
  Observed observed(scene);
  simulation.on_collision([&](const Collision& c) { observed.collision(c); });
  observed.sample({}, simulation.totals());
  simulation.advance(test::until_collisions(20));
  Values values = observed.sample({}, simulation.totals());
  const double count = values["collisions"][0];
  ASSERT_EQ(count, 20000);
  double square = 0, sine = 0;
  for (std::size_t bin = 0; bin < 60; ++bin) {
    const double x = (double(bin) + 0.5) / 10;
    square += values["normal_velocity"][bin] * x * x;
  }
  for (std::size_t bin = 0; bin < 45; ++bin) {
    const double x = (double(bin) + 0.5) * std::numbers::pi / 45;
    sine += values["angle"][bin] * std::pow(std::sin(x), 2);
  }
  EXPECT_NEAR(square / count, 2, 6 * 2 / std::sqrt(count));
  EXPECT_NEAR(sine / count, 0.75, 6 * 0.25 / std::sqrt(count));
  EXPECT_NEAR(values["repeats"][0] / count, 0.14, 0.02);
}

}  // namespace
}  // namespace needlework::observe
