// What a scene takes from the state that it starts from.
#include "src/scene/adopt_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "tests/scene/message.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

const Bodies thick_rods{.length = {2}, .diameter = {0.5}, .mass = {4}, .k = {2}};
const Bodies two_kinds{
    .names = {"rod", "ball"}, .length = {1, 0}, .diameter = {0.25, 1}, .mass = {1, 3}, .k = {3, 6}};

State state_of(const Bodies& bodies) {
  State state;
  state.box = {9, 9, 9};
  state.resize(3);
  if (bodies.species() > 1) state.species = {0, 1, 1};
  state.bodies = bodies;
  return state;
}

Scene adopted(const std::string& text, const Bodies& bodies) {
  Scene scene = parse_scene("initial.file = \"f.h5\"\nuntil.time = 1\n" + text, "s.toml");
  State state = state_of(bodies);
  adopt_state(scene, state);
  return scene;
}

std::string refusal_of_state(const std::string& text, const Bodies& bodies) {
  return test::refusal([&] { adopted(text, bodies); });
}

TEST(AdoptedState, SaysItsBodiesWhereTheSceneIsSilent) {
  for (const char* text : {"", "needles.count = 3", "needles.diameter = 0.5\nneedles.k = 2",
                           "[[species]]\nname = \"any\"\nmass = 4"}) {
    const Scene scene = adopted(text, thick_rods);
    const Composition composition = scene.composition();
    ASSERT_EQ(composition.size(), 1u);
    EXPECT_EQ(composition[0].length, 2);
    EXPECT_EQ(composition[0].diameter, 0.5);
    EXPECT_EQ(composition[0].mass, 4);
    EXPECT_EQ(composition[0].k, 2);
    EXPECT_EQ(composition[0].count, 3u);
    EXPECT_EQ(scene.needles.count, 3u);
  }
}

TEST(AdoptedState, KeepsTheShortFormOfNeedlesOfLengthAndMassOne) {
  const Scene scene = adopted("", {.length = {1}, .diameter = {0.25}, .mass = {1}, .k = {3}});
  EXPECT_TRUE(scene.species.empty());
  EXPECT_EQ(scene.needles.diameter, 0.25);
  EXPECT_EQ(scene.needles.k, 3);
}

TEST(AdoptedState, SaysThatItsBodiesAreFixed) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double diameter : {0.0, 0.25}) {
    const Bodies bodies{.length = {1}, .diameter = {diameter}, .mass = {infinite}, .k = {6}};
    EXPECT_TRUE(test::contains(refusal_of_state("", bodies),
                               "species.fixed = true: expected another species, which moves"));
  }
}

TEST(AdoptedState, HasSizesAndMomentsOfInertiaThatBodiesCanHave) {
  const auto refusal_of = [](std::vector<double> diameter, double inertia) {
    const std::vector<double> length = {diameter.empty() ? 1.0 : 0.0};
    return refusal_of_state(
        "collisions.beta = 0.5",
        {.length = length, .diameter = std::move(diameter), .mass = {1}, .inertia = {inertia}});
  };
  const double infinite = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& diameter : {std::vector<double>{}, {1.0}}) {
    for (const auto& [inertia, text] : {std::pair(-5.0, "-5 of its bodies: expected a number of"),
                                        {std::nan(""), "nan of its bodies: expected a number of"},
                                        {infinite, "inf of its bodies: expected a finite number"}})
      EXPECT_TRUE(test::contains(refusal_of(diameter, inertia), text)) << inertia;
  }
  EXPECT_TRUE(test::contains(refusal_of({}, 0), "0 of its bodies: expected a number above 0"));
  EXPECT_EQ(refusal_of({}, 0.05), "no error");
  EXPECT_EQ(refusal_of({1}, 0.05), "no error");
  EXPECT_EQ(refusal_of({1}, 0), "no error") << "a smooth sphere does not say one";
  EXPECT_TRUE(test::contains(refusal_of_state("needles.box = 9", {.diameter = {-1}}),
                             "needles.diameter = -1: expected "));
}

TEST(AdoptedState, SaysNamesAndCountsOfSpecies) {
  const Scene scene = adopted("[[pairs]]\nbetween = [\"ball\", \"rod\"]\nepsilon = 0.5", two_kinds);
  ASSERT_EQ(scene.species.size(), 2u);
  EXPECT_EQ(scene.species[1].name, "ball");
  EXPECT_EQ(scene.species[1].count, 2u);
  EXPECT_EQ(scene.species[1].length, 0);
  EXPECT_EQ(scene.composition().restitution(0, 1).epsilon, 0.5);
  // Also where the scene begins to say them.
  const Scene named =
      adopted("[[species]]\nname = \"rod\"\n[[species]]\nname = \"ball\"\nlength = 0", two_kinds);
  EXPECT_EQ(named.species[0].diameter, 0.25);
  EXPECT_EQ(named.species[1].diameter, 1);
  EXPECT_EQ(named.species[1].mass, 3);
}

TEST(AdoptedState, IsNotContradicted) {
  for (const auto& [text, message] :
       {std::pair("needles.k = 6", "s.toml: line 3: needles.k = 6: expected 2, as in f.h5"),
        {"needles.diameter = 0.1",
         "s.toml: line 3: needles.diameter = 0.1: expected 0.5, as in f.h5"},
        {"[[species]]\nname = \"a\"\nlength = 1",
         "s.toml: line 5: species.length = 1: expected 2, as in f.h5"},
        {"[[species]]\nname = \"a\"\nmass = 1",
         "s.toml: line 5: species.mass = 1: expected 4, as in f.h5"},
        {"[[species]]\nname = \"a\"\ninertia = 3",
         "s.toml: line 5: species.inertia = 3: expected 4, as in f.h5"}}) {
    EXPECT_EQ(refusal_of_state(text, thick_rods), message);
  }
  EXPECT_EQ(refusal_of_state("[[species]]\nname = \"a\"\ninertia = 4", thick_rods), "no error");
  EXPECT_EQ(
      refusal_of_state("[[species]]\nname = \"rod\"\n[[species]]\nname = \"sphere\"", two_kinds),
      "s.toml: line 6: species.name = \"sphere\": expected \"ball\", as in f.h5");
  EXPECT_EQ(refusal_of_state("[[species]]\nname = \"rod\"", two_kinds),
            "s.toml: line 4: species.name = \"rod\": expected 2 [[species]]: rod, ball, not 1, as "
            "in f.h5");
  EXPECT_EQ(refusal_of_state("[[pairs]]\nbetween = [\"ball\", \"cube\"]", two_kinds),
            "s.toml: line 4: pairs.between = [\"ball\", \"cube\"]: expected names of two "
            "[[species]], among rod, ball");
}

// A file that does not say whether its bodies have an axis leaves that to the scene.
TEST(AdoptedState, TurnsAboutNoAxis) {
  const auto refusal_of = [](const std::string& text, double along, double across) {
    return test::refusal([&] {
      Scene scene = parse_scene("initial.file = \"f.h5\"\nuntil.time = 1\n" + text, "s.toml");
      State state = state_of({});
      state.id = {};
      state.orientation.assign(3, {1, 0, 0});
      state.angular_velocity[1] = {along, 0, across};
      adopt_state(scene, state);
    });
  };
  EXPECT_EQ(
      refusal_of("", 3, 4),
      "s.toml: line 1: initial.file = \"f.h5\": needle 1: angular velocity (3, 0, 4), of which 3 "
      "is along its director: expected none, within 1e-06 of its length");
  // As wrong at the ends of the range of numbers.
  EXPECT_NE(refusal_of("", 3e-320, 4e-320), "no error");
  EXPECT_NE(refusal_of("", 3e307, 1e308), "no error");
  EXPECT_EQ(refusal_of("", 0, 4), "no error");
  EXPECT_EQ(refusal_of("species = [{ name = \"a\", count = 3, length = 0, diameter = 1 }]", 3, 4),
            "no error");
}

TEST(AdoptedState, IsOfBodiesThatTheSceneCanSimulate) {
  EXPECT_TRUE(test::contains(refusal_of_state("collisions.beta = 0", thick_rods),
                             "-1 of pairs with a rod of finite width"));
  EXPECT_TRUE(
      test::contains(refusal_of_state("collisions.sliding = true", thick_rods), "do not slide"));
  // The room is that of its bodies, not that of needles of length 1.
  const Bodies short_needles{.length = {0.1}, .diameter = {0}, .mass = {1}, .k = {6}};
  Scene scene = parse_scene("initial.file = \"f.h5\"\nuntil.time = 1\nneedles.box = 1", "s.toml");
  State state = state_of(short_needles);
  state.box = {1, 1, 1};
  EXPECT_NO_THROW(adopt_state(scene, state));
}

TEST(AdoptedState, SaysWhatNobodyKnows) {
  const auto warning = [](const std::string& text, const Bodies& bodies) {
    return warning_of_unknown_bodies(adopted(text, bodies), bodies);
  };
  EXPECT_EQ(warning("", thick_rods), "");
  EXPECT_EQ(warning("", two_kinds), "");
  EXPECT_EQ(
      warning("", {}),
      "s.toml: line 1: initial.file = \"f.h5\": says no length, no diameter, no mass, no k of "
      "its bodies, and neither does the scene: the default is taken");
  EXPECT_EQ(warning("needles.diameter = 0.1", {.mass = {1}}),
            "s.toml: line 1: initial.file = \"f.h5\": says no length, no k of its bodies, and "
            "neither does the scene: the default is taken");
  EXPECT_EQ(
      warning("[[species]]\nname = \"a\"\nlength = 1\ndiameter = 0\nmass = 1\ninertia = 1", {}),
      "");
}

}  // namespace
}  // namespace needlework
