// Bodies of species that pass through each other.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "tests/support/audited.h"
#include "tests/support/message_of.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::until_collisions;
using test::until_time;

Scene::Pair passing(const char* a, const char* b) {
  return {.between = {a, b}, .epsilon = {}, .beta = {}, .meet = false};
}

/// Ghosts that only meet the others.
Scene ghosts_among_needles() {
  Scene scene = test::inelastic(test::scene_of(0, 8, 3), 0.9);
  scene.species = {{.name = "ghosts", .count = 300, .length = 1},
                   {.name = "others", .count = 150, .length = 1.6, .mass = 2}};
  scene.pairs = {passing("ghosts", "ghosts")};
  return scene;
}

/// Rods in big spheres, which overlap and meet nothing but small ones.
Scene rods_in_spheres() {
  Scene scene = test::scene_of(0, 7, 3);
  scene.species = {{.name = "rods", .count = 150, .length = 2, .diameter = 0.3},
                   {.name = "big", .count = 90, .length = 0, .mass = 3, .diameter = 1.4},
                   {.name = "small", .count = 60, .length = 0, .diameter = 0.5}};
  scene.pairs = {passing("big", "big"), passing("rods", "big")};
  return scene;
}

std::vector<Scene> scenes() { return {ghosts_among_needles(), rods_in_spheres()}; }

// Of all pairs, and that no two collide that do not meet.
TEST(Passing, HasOneTrajectory) {
  for (const Scene& scene : scenes()) {
    const Composition composition = scene.composition();
    Simulation first(test::searched_by(scene, "all-pairs"));
    first.advance(until_collisions(4));
    const std::vector<std::uint64_t> collisions = first.collisions_by_pair();
    for (std::size_t a = 0; a < composition.size(); ++a) {
      for (std::size_t b = a; b < composition.size(); ++b) {
        EXPECT_EQ(collisions[composition.pair_index(a, b)] > 0, composition.meets(a, b));
      }
    }
    for (const char* search : {"linked-lists", "linked-cells", "capsules", "auto"}) {
      EXPECT_EQ(test::hash_of(test::searched_by(scene, search), until_collisions(4)),
                first.trajectory_hash())
          << search;
    }
    for (const char* search : {"linked-cells", "capsules"}) {
      EXPECT_EQ(
          test::hash_of(test::on_threads(test::searched_by(scene, search), 2), until_collisions(4)),
          first.trajectory_hash())
          << search << " on 2";
    }
  }
}

// What two never-meeting gases do in one box is what each does alone.
TEST(Passing, LeavesTwoGasesAlone) {
  Scene both = test::scene_of(0, 6, 5);
  both.species = {{.name = "a", .count = 100}, {.name = "b", .count = 80, .length = 0.7}};
  both.pairs = {passing("a", "b")};
  const State drawn = draw_initial_state(both);
  Scene alone = both;
  alone.pairs.clear();
  alone.species.pop_back();
  State of_a = drawn;
  of_a.resize(100);
  of_a.species.clear();
  of_a.id.clear();
  of_a.image.clear();
  Simulation together(both, drawn), apart(alone, of_a);
  together.advance(until_time(3));
  apart.advance(until_time(3));
  EXPECT_EQ(together.collisions_by_pair()[0], apart.collisions());
  const State end = together.copy(), expected = apart.copy();
  for (std::size_t i = 0; i < 100; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(end.velocity[i][axis], expected.velocity[i][axis], 1e-9);
  }
}

TEST(Passing, GoesOnFromACheckpoint) {
  for (const Scene& scene : scenes()) {
    Scene other = scene;
    other.pairs.clear();
    if (scene.species.size() == 3) other.pairs = {passing("big", "big"), passing("rods", "small")};
    test::expect_to_continue(scene, 0.3, 0.7, other);
  }
}

TEST(Passing, IsAudited) {
  for (const Scene& scene : scenes())
    test::expect_clean(test::audited(scene, 0.5), test::name_of(scene));
  Scene scene = ghosts_among_needles();
  scene.pairs.clear();
  audit::Setup setup = test::audit_setup(scene, Simulation(scene).epoch_length());
  setup.composition.set_meets(0, 0, false);
  const audit::Findings findings = test::audited(scene, 0.5, setup);
  EXPECT_GT(findings.count(audit::Kind::spurious), 10u);
}

// All that is left is to fly.
TEST(Passing, OfAllSpeciesEndsAtOnce) {
  Scene one = test::scene_of(0, 5);
  one.species = {{.name = "a", .count = 50}};
  one.pairs = {passing("a", "a")};
  Scene two = test::scene_of(0, 7);
  two.species = {{.name = "a", .count = 50, .length = 0, .diameter = 1},
                 {.name = "b", .count = 1, .length = 2, .diameter = 1},
                 {.name = "none", .count = 0}};
  two.species[2].diameter = 0.5;
  two.pairs = {passing("a", "a"), passing("a", "b")};
  for (const Scene& scene : {one, two}) {
    const std::string why = "all needles pass through each other, as pairs.meet = false says";
    EXPECT_EQ(why_no_collision(scene), why);
    EXPECT_EQ(why_no_collision(scene, draw_initial_state(scene)), why);
    Simulation simulation(scene);
    EXPECT_EQ(simulation.why_no_collision(), why);
    EXPECT_EQ(simulation.advance(until_collisions(1)), Stop::nothing_can_happen);
    EXPECT_EQ(simulation.advance(until_time(1e3)), Stop::time);
    EXPECT_EQ(simulation.counters().events, 0u);
    Scene walled = scene;
    walled.walls = {{.axis = "z", .side = "both"}};
    walled.until.collisions_per_needle = 1;
    EXPECT_EQ(why_no_collision(walled), why);
    Simulation between(walled);
    EXPECT_EQ(between.advance(until_collisions(1)), Stop::nothing_can_happen);
    EXPECT_EQ(between.advance(until_time(1)), Stop::time);
    EXPECT_GT(between.counters().events, 10u);
    EXPECT_EQ(between.collisions(), 0u);
  }
}

TEST(Passing, NeedsNoRoom) {
  Scene scene = test::scene_of(0, 4);
  scene.species = {{.name = "a", .count = 200, .length = 0, .diameter = 1.5}};
  EXPECT_THROW(draw_initial_state(scene), InputError);
  scene.pairs = {passing("a", "a")};
  const State state = draw_initial_state(scene);
  EXPECT_NO_THROW(Simulation(scene, state));
  scene.pairs.clear();
  EXPECT_THROW(Simulation(scene, state), InputError);
}

}  // namespace
}  // namespace needlework
