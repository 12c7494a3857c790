// Needles that slide on each other beside walls, and under gravity.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/isa.h"
#include "src/calendar/names.h"
#include "src/physics/vectors.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

Scene above_a_floor(std::uint64_t count, double epsilon, std::uint64_t seed) {
  Scene scene;
  scene.needles.count = count;
  scene.needles.box = {3, 3, 3};
  scene.needles.seed = seed;
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

std::string hash_of_run(const Scene& scene, double collisions) {
  Simulation simulation(scene);
  simulation.advance(test::until_collisions(collisions));
  return simulation.trajectory_hash();
}

// Walls of all kinds, by what they do.
enum class Kind { resting, inelastic, moving, thermal };

Scene beside_walls(Kind kind, double epsilon) {
  Scene scene = above_a_floor(50, epsilon, 3);
  Scene::Wall& wall = scene.walls.front();
  if (kind == Kind::inelastic) wall.epsilon = 0.7;
  if (kind == Kind::thermal) wall.temperature = 1;
  if (kind == Kind::moving) {
    scene.walls = {{.axis = "z", .side = "low"}, {.axis = "z", .side = "high"}};
    scene.walls[0].motion = {.amplitude = 0.1, .frequency = 2, .phase = 0};
  }
  return scene;
}

// Until the needles of the coldest gas lie on the floor.
TEST(SlidingBesideWalls, KeepsAnAccountOfTheEnergyThatCloses) {
  for (const Kind kind : {Kind::resting, Kind::inelastic, Kind::moving, Kind::thermal}) {
    for (const double epsilon : {0.0, 0.5}) {
      Simulation simulation(beside_walls(kind, epsilon));
      double most = -1;
      for (int n = 1; n <= 50; ++n) {
        simulation.advance(test::until_time(0.02 * n));
        if (kind != Kind::moving) most = std::max(most, beyond_walls(simulation.copy()));
      }
      EXPECT_LT(std::abs(simulation.energy_drift()), 1e-11);
      EXPECT_LT(most, 1e-11);
      const SlidingContacts contacts = *simulation.sliding_contacts();
      EXPECT_GT(contacts.entered, epsilon == 0 ? 20u : 0u);
      if (epsilon == 0) {
        EXPECT_GT(contacts.ended_by_strike, 10u);
      }
      const std::vector<WallTotals> walls = simulation.wall_totals();
      EXPECT_GT(walls[0].hits + walls[1].hits, 20u);
    }
  }
}

TEST(SlidingBesideWalls, HasOneTrajectory) {
  for (const Kind kind : {Kind::resting, Kind::inelastic, Kind::moving, Kind::thermal}) {
    Scene scene = beside_walls(kind, 0.4);
    std::string hash;
    for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
      for (const std::string& calendar : calendar_names()) {
        scene.engine.search = search;
        scene.engine.queue = calendar;
        Simulation simulation(scene);
        simulation.advance(test::until_collisions(12));
        if (hash.empty()) hash = simulation.trajectory_hash();
        ASSERT_EQ(simulation.trajectory_hash(), hash) << search << ", " << calendar;
        EXPECT_GT(simulation.sliding_contacts()->entered, 5u);
      }
    }
  }
}

TEST(SlidingBesideWalls, HasOneTrajectoryOnEveryInstructionSet) {
  Scene scene = beside_walls(Kind::moving, 0);
  const std::string hash = hash_of_run(scene, 10);
  for (const char* search : {"linked-cells", "capsules"}) {
    for (const kernels::Isa isa : kernels::available()) {
      scene.engine.search = search;
      scene.engine.isa = kernels::name_of(isa);
      EXPECT_EQ(hash_of_run(scene, 10), hash) << search << ", " << scene.engine.isa;
    }
  }
}

TEST(SlidingBesideWalls, HasOneTrajectoryOnThreads) {
  Scene scene = above_a_floor(500, 0.3, 9);
  scene.needles.box = {8, 8, 8};
  scene.walls.front().epsilon = 0.8;
  const std::string hash = hash_of_run(scene, 10);
  scene.engine.team = "all";
  for (const char* search : {"linked-cells", "capsules"}) {
    for (const int threads : {2, 3}) {
      scene.engine.search = search;
      scene.engine.threads = threads;
      EXPECT_EQ(hash_of_run(scene, 10), hash) << search << ", " << threads;
    }
  }
}

// At many times, so that contacts last at most of them.
TEST(SlidingBesideWalls, GoesOnFromCheckpoints) {
  for (const Kind kind : {Kind::inelastic, Kind::thermal}) {
    const Scene scene = beside_walls(kind, 0.2);
    Scene other = scene;
    other.collisions.sliding_below = 2e-3;
    for (double saved = 0.1; saved < 0.8; saved += 0.1)
      test::expect_to_continue(scene, saved, saved + 0.2, other);
  }
}

TEST(SlidingBesideWalls, HasOneTrajectoryInMixtures) {
  Scene scene = above_a_floor(0, 0.3, 8);
  scene.needles.box = {4, 4, 4};
  scene.species = {
      {.name = "long", .count = 20, .length = 1.5, .mass = 2.5, .k = 3, .t_tr = 1, .t_rot = 1},
      {.name = "short", .count = 60, .length = 0.4, .mass = 0.3, .k = 6, .t_tr = 1, .t_rot = 2}};
  Simulation simulation(scene);
  simulation.advance(test::until_collisions(15));
  EXPECT_LT(std::abs(simulation.energy_drift()), 1e-11);
  EXPECT_GT(simulation.sliding_contacts()->entered, 20u);
  for (const char* search : {"all-pairs", "capsules"}) {
    scene.engine.search = search;
    EXPECT_EQ(hash_of_run(scene, 15), simulation.trajectory_hash()) << search;
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
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(a.orientation[i][axis], b.orientation[i][axis], 1e-10) << seed;
          EXPECT_NEAR(a.angular_velocity[i][axis], b.angular_velocity[i][axis], 1e-10) << seed;
        }
      }
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
