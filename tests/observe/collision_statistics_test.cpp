// Statistics of collisions that are known, and of a gas in equilibrium.
#include <cmath>
#include <numbers>

#include "tests/observe/observed.h"
#include "tests/support/rods.h"

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

// A rod that is hit along its axis does not turn: only the other one's rotation adds to V_n.
TEST(CollisionStatistics, OfRodsCountTheNormalOfTheContact) {
  Scene scene = test::rods_of(2, 2, 0.01);
  scene.output.observables = {"collision_statistics"};
  const double inertia = scene.species[0].inertia(), arm = 0.91;
  Observed observed(scene);
  Totals totals;
  totals.t_tr = 1;
  totals.t_rot = 0.5;
  observed.sample({}, totals);
  const auto bin_for = [&](const Vector& impulse, double squares) {
    Collision c = collision_of(0, 1);
    c.arm_first = 1;
    c.arm_second = arm;
    c.after[1].orientation = {1, 0, 0};
    c.sin_angle = 1;
    c.impulse = impulse;
    c.normal_velocity = -1.55 * std::sqrt(squares);  // in the middle of bin 15
    observed.collision(c);
    const Values values = observed.sample({}, totals);
    EXPECT_EQ(values.at("arms")[47], 1) << "0.91 of 2";
    EXPECT_EQ(values.at("arms")[49], 1) << "1 of 2, a tip";
    return values.at("normal_velocity")[15];
  };
  const double first = 0.5 * 1 / inertia, second = 0.5 * arm * arm / inertia;
  EXPECT_EQ(bin_for({0, 0, 3}, 2 + second), 1);
  EXPECT_EQ(bin_for({2, 0, 0}, 2 + first), 1);
  EXPECT_EQ(bin_for({0, -1, 0}, 2 + first + second), 1);
  EXPECT_EQ(bin_for({0, 0.6, 0.8}, 2 + 0.36 * first + second), 1);
}

// In equilibrium <x^2> = 2 with variance 4 at every density, whatever the shape. Repeats of a pair
// are correlated, so errors are allowed to be some times those of counts.
TEST(CollisionStatistics, OfRodsAndSpheresFollowTheLawOfNormalVelocities) {
  for (const double length : {-1.0, 0.0, 5.0}) {
    // Thin needles, spheres and rods.
    Scene scene = length < 0 ? test::scene_of(200, 6.5, 4) : test::rods_of(200, length, 0.2);
    scene.output.observables = {"collision_statistics"};
    Simulation simulation(scene);
    Observed observed(scene);
    simulation.on_collision([&](const Collision& c) { observed.collision(c); });
    observed.sample({}, simulation.totals());
    simulation.advance(test::until_collisions(100));
    const Values values = observed.sample({}, simulation.totals());
    const double count = values.at("collisions")[0];
    ASSERT_EQ(count, 10000);
    double square = 0;
    for (std::size_t bin = 0; bin < 60; ++bin) {
      const double x = (double(bin) + 0.5) / 10;
      square += values.at("normal_velocity")[bin] * x * x;
    }
    EXPECT_NEAR(square / count, 2, 5 * 2 / std::sqrt(count)) << length;
    const std::vector<double>& arms = values.at("arms");
    EXPECT_EQ(sum(arms), 2 * count) << length;
    if (length == 0) {
      EXPECT_EQ(arms[25], 2 * count) << "at the centre";
    }
  }
}

}  // namespace
}  // namespace needlework::observe
