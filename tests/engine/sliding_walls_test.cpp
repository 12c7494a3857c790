// Needles that slide on each other beside walls, and under gravity.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/physics/vectors.h"
#include "tests/support/all_near.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

Scene above_a_floor(std::uint64_t count, double epsilon, std::uint64_t seed) {
  Scene scene = test::scene_of(count, 3, seed);
  scene.collisions.epsilon = epsilon;
  scene.collisions.sliding = true;
  scene.walls = {{.axis = "z", .side = "both"}};
  scene.forces.gravity = {0, 0, -2};
  return scene;
}

// By the lowest and the highest tip, how far one is beyond a wall along z.
double beyond_walls(const State& state) {
  double out = -1;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double reach = 0.5 * std::abs(state.orientation[i][2]);
    out = std::max({out, reach - state.position[i][2], state.position[i][2] + reach - 3});
  }
  return out;
}

// Until the needles of the coldest gas lie on the floor.
TEST(SlidingBesideWalls, KeepsNeedlesBetweenThem) {
  for (const char* kind : {"floor", "inelastic", "thermal"}) {
    for (const double epsilon : {0.0, 0.5}) {
      Scene scene = above_a_floor(50, epsilon, 3);
      if (kind[0] == 'i') scene.walls[0].epsilon = 0.7;
      if (kind[0] == 't') scene.walls[0].temperature = 1;
      Simulation simulation(scene);
      for (int n = 1; n <= 50; ++n) {
        simulation.advance(test::until_time(0.02 * n));
        EXPECT_LT(beyond_walls(simulation.copy()), 1e-11) << kind << ", " << epsilon;
      }
      EXPECT_GT(simulation.sliding_contacts()->entered, epsilon == 0 ? 20u : 0u);
      if (epsilon == 0) {
        EXPECT_GT(simulation.sliding_contacts()->ended_by_strike, 10u);
      }
    }
  }
}

// Of two needles alone, nothing but walls strikes.
TEST(SlidingBesideWalls, IsCutByHits) {
  Scene scene = above_a_floor(2, 0, 1);
  scene.forces.gravity = {0, 0, 0};
  scene.needles.box = {2.2, 2.2, 3};
  std::uint64_t struck = 0;
  double most = -1;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    scene.needles.seed = seed;
    Simulation simulation(scene);
    simulation.on_happening([&](const Happening& what) {
      if (what.kind != Happening::wall) return;
      EXPECT_LE(what.event.normal_velocity, 0);
    });
    for (int n = 1; n <= 100; ++n) {
      simulation.advance(test::until_time(0.1 * n));
      most = std::max(most, beyond_walls(simulation.copy()));
    }
    EXPECT_LT(std::abs(simulation.energy_drift()), 1e-12) << seed;
    struck += simulation.sliding_contacts()->ended_by_strike;
  }
  EXPECT_GT(struck, 3u);
  EXPECT_LT(most, 1e-12);
}

// Two needles that collide while they fall slide on each other as they do without gravity, and
// what all of a gas has in common is in none of its contacts.
TEST(SlidingUnderGravity, IsThatOfNeedlesThatDoNotFall) {
  Scene scene = above_a_floor(2, 0, 1);
  scene.needles.box = {6, 6, 400};
  int slid = 0;
  for (std::uint64_t seed = 1; seed <= 400 && slid < 12; ++seed) {
    scene.needles.seed = seed;
    State state = draw_initial_state(scene);
    for (std::size_t i : {0, 1})
      state.position[i][2] += 200 - 0.5 * (state.position[0][2] + state.position[1][2]);
    // Near each other, so that they collide soon.
    for (int axis = 0; axis < 3; ++axis)
      state.position[1][axis] = state.position[0][axis] + 0.3 * state.orientation[1][axis];
    Simulation falls(scene, state);
    Scene floats = scene;
    floats.forces.gravity = {0, 0, 0};
    Simulation rests(floats, state);
    for (int n = 1; n <= 40; ++n) {
      const double time = 0.05 * n;
      falls.advance(test::until_time(time));
      rests.advance(test::until_time(time));
      const State a = falls.copy(), b = rests.copy();
      for (std::size_t i : {0, 1}) {
        const double fallen = -time * time, faster = -2 * time;
        EXPECT_NEAR(a.position[i][2] - fallen, b.position[i][2], 1e-10) << seed;
        EXPECT_NEAR(a.velocity[i][2] - faster, b.velocity[i][2], 1e-10) << seed;
      }
      EXPECT_TRUE(test::all_near(a.orientation, b.orientation, 1e-10)) << seed;
      EXPECT_TRUE(test::all_near(a.angular_velocity, b.angular_velocity, 1e-10)) << seed;
    }
    EXPECT_EQ(falls.sliding_contacts()->entered, rests.sliding_contacts()->entered) << seed;
    EXPECT_EQ(falls.sliding_contacts()->ended_by_force, rests.sliding_contacts()->ended_by_force);
    EXPECT_EQ(falls.sliding_contacts()->ended_by_tip, rests.sliding_contacts()->ended_by_tip);
    slid += falls.sliding_contacts()->entered > 0;
  }
  EXPECT_EQ(slid, 12);
}

}  // namespace
}  // namespace needlework
