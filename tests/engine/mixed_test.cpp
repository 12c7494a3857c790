// Thin needles among rods of finite width and spheres.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "src/engine/initial_gas.h"
#include "src/engine/rods_apart.h"
#include "src/scene/validity.h"
#include "tests/support/audited.h"
#include "tests/support/message_of.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::until_collisions;
using test::until_time;

Species thin(std::uint64_t count, double length = 1) {
  return {.name = "needles", .count = count, .length = length};
}
Species balls(std::uint64_t count, double diameter, double mass) {
  return {.name = "balls", .count = count, .length = 0, .mass = mass, .diameter = diameter};
}

/// Needles that cross, and spheres of a size like theirs.
Scene needles_and_balls() {
  Scene scene = test::inelastic(test::scene_of(0, 7, 4), 0.9);
  scene.species = {thin(250), balls(40, 0.9, 3)};
  return scene;
}

/// Rough needles among smooth ones, thin rods and spheres that are hardly wider than they.
Scene rough_needles_and_rods() {
  Scene scene = test::scene_of(0, 6, 4);
  scene.species = {thin(200),
                   {.name = "rods", .count = 60, .length = 1.5, .mass = 2, .diameter = 0.1},
                   balls(100, 0.02, 0.5),
                   {.name = "smooth", .count = 60, .length = 0.7, .k = 4}};
  scene.pairs = {{.between = {"needles", "needles"}, .epsilon = 0.8, .beta = 0.4}};
  scene.collisions.tc_relative = 1e-3;
  return scene;
}

/// Few large spheres among many needles that pass through each other.
Scene passing_needles_and_balls() {
  Scene scene = test::scene_of(0, 9, 4);
  scene.species = {thin(600, 0.5), balls(8, 3, 40)};
  scene.pairs = {{.between = {"needles", "needles"}, .epsilon = {}, .beta = {}, .meet = false}};
  return scene;
}

std::vector<Scene> scenes_of_both() {
  return {needles_and_balls(), rough_needles_and_rods(), passing_needles_and_balls()};
}

void expect_one_trajectory(const Scene& scene, double collisions) {
  const Scene::Until until = until_collisions(collisions);
  const std::string first = test::hash_of(test::searched_by(scene, "all-pairs"), until);
  for (const char* search : {"linked-lists", "linked-cells", "capsules", "auto"})
    EXPECT_EQ(test::hash_of(test::searched_by(scene, search), until), first) << search;
  if (scene.forces.gravity[2] != 0) return;
  for (const char* search : {"linked-cells", "capsules"}) {
    const Scene on_two = test::on_threads(test::searched_by(scene, search), 2);
    EXPECT_EQ(test::hash_of(on_two, until), first) << search << " on 2 threads";
  }
}

TEST(Mixed, HasOneTrajectory) {
  for (const Scene& scene : scenes_of_both()) expect_one_trajectory(scene, 3);
}

TEST(Mixed, HasOneTrajectoryForLong_long) {
  for (const Scene& scene : scenes_of_both()) expect_one_trajectory(scene, 30);
}

/// What else may act on such a gas.
std::vector<Scene> driven_scenes() {
  Scene walled = needles_and_balls();
  walled.walls = {{.axis = "x", .side = "both"}, {.axis = "z", .side = "low", .epsilon = 0.9}};
  walled.forces.gravity = {0, 0, -1};
  Scene driven = needles_and_balls();
  driven.driving.kicks = {.every = 0.1, .translational = 0.3, .rotational = 0.2};
  driven.driving.andersen = {.rate = 0.5, .temperature = 1.5};
  Scene sheared = needles_and_balls();
  sheared.shear = Scene::Shear{.rate = 0.7, .offset = 0.3};
  return {walled, driven, sheared};
}

TEST(Mixed, HasOneTrajectoryWithOtherEffects) {
  for (const Scene& scene : driven_scenes()) expect_one_trajectory(scene, 2);
}

TEST(Mixed, MeetsInAllPairs) {
  Simulation gas(needles_and_balls());
  gas.advance(until_collisions(5));
  for (const std::uint64_t collisions : gas.collisions_by_pair()) EXPECT_GT(collisions, 5u);
  EXPECT_GT(gas.virial(), 0);
}

TEST(Mixed, KeepsItsEnergyAndDoesNotOverlap) {
  for (Scene scene : scenes_of_both()) {
    scene.collisions = {};
    scene.pairs.erase(
        std::remove_if(scene.pairs.begin(), scene.pairs.end(), [](auto& p) { return p.meet; }),
        scene.pairs.end());
    Simulation gas(scene);
    const double energy = gas.totals().energy;
    gas.advance(until_collisions(10));
    EXPECT_NEAR(gas.totals().energy / energy, 1, 1e-12);
    EXPECT_LT(std::abs(gas.energy_drift()), 1e-12);
    // Which a state that overlaps could not.
    EXPECT_NO_THROW(Simulation(scene, gas.copy()));
  }
}

TEST(Mixed, IsAudited) {
  for (const Scene& scene : scenes_of_both())
    test::expect_clean(test::audited(scene, 0.3), test::name_of(scene));
  for (const Scene& scene : driven_scenes()) {
    Scene one = scene;
    if (one.driving.kicks) one.driving.andersen.reset();
    test::expect_clean(test::audited(one, 0.3), test::name_of(one));
  }
}

TEST(Mixed, GoesOnFromACheckpoint) {
  for (const Scene& scene : scenes_of_both()) {
    Scene other = scene;
    other.species[1].diameter *= 0.99;
    test::expect_to_continue(scene, 0.2, 0.5, other);
  }
}

// A needle of no width falls onto a sphere, and onto a rod across it.
TEST(Mixed, NeedlesTouchRodsAtTheirRadius) {
  for (const double length : {0.0, 2.0}) {
    Scene scene = test::scene_of(0, 6);
    scene.species = {{.name = "needle", .count = 1, .length = 1.5},
                     {.name = "body", .count = 1, .length = length, .diameter = 0.5}};
    State state = draw_initial_state(scene);
    state.position = {{3, 3, 5}, {3, 3, 3}};
    state.orientation = {{1, 0, 0}, {0, 1, 0}};
    state.velocity = {{0, 0, -1}, {0, 0, 0}};
    state.angular_velocity = {{0, 0, 0}, {0, 0, 0}};
    test::Followed gas(scene, state);
    gas->advance(until_time(2));
    ASSERT_EQ(gas.collisions.size(), 1u);
    EXPECT_NEAR(gas.collisions[0].time, 1.75, 1e-14);
    EXPECT_NEAR(gas.collisions[0].after[0].velocity[2], 0, 1e-14);
    state.position[0] = {3, 3, 3.24};
    EXPECT_EQ(test::message_of<InputError>([&] { Simulation(scene, state); }),
              "state: rods 0 and 1 overlap: their axes are 0.24 apart, less than 0.25");
  }
}

TEST(Mixed, RefusesRoughContactsWithRods) {
  Scene scene = rough_needles_and_rods();
  EXPECT_NO_THROW(require_valid(scene, simulable));
  scene.pairs[0].between = {"needles", "rods"};
  EXPECT_NE(test::message_of<InputError>([&] { Simulation gas(scene); }).find("pairs.beta = 0.4"),
            std::string::npos);
  scene.pairs.clear();
  scene.collisions.beta = 0.2;
  EXPECT_NE(
      test::message_of<InputError>([&] { Simulation gas(scene); }).find("collisions.beta = 0.2"),
      std::string::npos);
  scene.collisions.beta = -1;
  scene.collisions.tc_relative.reset();
  scene.collisions.sliding = true;
  EXPECT_THROW(Simulation gas(scene), InputError);
}

}  // namespace
}  // namespace needlework
