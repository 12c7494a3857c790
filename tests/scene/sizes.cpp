// Numbers of bodies that are drawn, given as arrays, or follow from each other.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/parse.h"
#include "needlework/simulation.h"
#include "src/scene/adopt_state.h"
#include "src/scene/own_bodies.h"
#include "tests/scene/message.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

const std::string head =
    "needles.box = 20\nuntil.time = 1\n[[species]]\nname = \"a\"\ncount = 20\n";
const std::string lengths = "length = { distribution = \"lognormal\", mean = 1, width = 0.3 }\n";

Scene parsed(const std::string& text, const std::vector<std::string>& overrides = {},
             Provided provided = {}) {
  return parse_scene(text, "s.toml", overrides, provided);
}

std::string refused(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return test::refusal([&] { parsed(text, overrides); });
}

TEST(Sizes, ExcludeOtherKeysOfTheirSpeciesAlone) {
  const Scene scene = parsed(head + lengths + "[[species]]\nname = \"b\"\ncount = 3\nlength = 2\n");
  EXPECT_TRUE(scene.composition()[0].sizes);
  EXPECT_EQ(scene.composition()[1].length, 2);
  EXPECT_EQ(refused(head + "mass = { density = 1, distribution = \"uniform\", mean = 1 }\n"),
            "s.toml: line 6: species.mass.distribution = \"uniform\": expected either mass.density "
            "or mass.distribution, not both");
}

TEST(Sizes, AreReplacedByOverridesOfTheirSpeciesAlone) {
  const std::string text = head + lengths + "[[species]]\nname = \"b\"\ncount = 3\n" + lengths;
  const Composition composition = parsed(text, {"species.b.length=2"}).composition();
  EXPECT_TRUE(composition[0].sizes);
  EXPECT_FALSE(composition[1].sizes);
  EXPECT_EQ(composition[1].length, 2);
}

// Each body has the moment of inertia that the scene says, not that of the mean k.
TEST(Sizes, LeaveANumberOfTheSpeciesToAll) {
  const Scene scene = parsed(head + lengths + "inertia = 0.2\nmass = 3\n");
  for (const BodyNumbers& body : drawn_bodies(scene)) {
    EXPECT_EQ(body.inertia, 0.2);
    EXPECT_EQ(body.mass, 3);
  }
}

TEST(Sizes, OfRodsAreThoseOfHomogeneousOnesUnlessTheSceneSaysK) {
  for (const char* mass : {"", "mass.density = 2\n"}) {
    const std::string text = head + lengths + "diameter.aspect = 4\n" + mass;
    for (const BodyNumbers& body : drawn_bodies(parsed(text))) {
      EXPECT_EQ(body.diameter, body.length / 4);
      const double k = homogeneous_k(body.length, body.diameter);
      EXPECT_EQ(body.inertia, body.mass * (body.length * body.length) / (2 * k));
    }
    for (const BodyNumbers& body : drawn_bodies(parsed(text + "k = 6\n")))
      EXPECT_EQ(body.inertia, body.mass * (body.length * body.length) / 12);
  }
}

TEST(Sizes, MayBeThoseOfSpheres) {
  const Scene scene = parsed(
      head + "length = 0\ndiameter = { distribution = \"uniform\", mean = 1, width = 0.2 }\n");
  EXPECT_TRUE(scene.composition().are_spheres());
  EXPECT_EQ(refused(head + "length = 0\ndiameter.aspect = 2\n"),
            "s.toml: line 6: species.length = 0: needle 0 would have 0: expected one above "
            "0, or a diameter, which makes it a sphere");
}

State state_of(std::size_t count) {
  State state;
  state.box = {20, 20, 20};
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i);
    state.position.push_back({std::fmod(4 * x, 20), 4 * std::floor(x / 5), 1});
    state.velocity.push_back({1, x, 0});
    state.orientation.push_back({0, 0, 1});
    state.angular_velocity.push_back({x, 0, 0});
  }
  return state;
}

// What arrays do not say is drawn by id, as for a state that is drawn.
TEST(Sizes, OfAGivenStateAreDrawnByItsIds) {
  Scene scene = parsed(head + lengths + "mass.density = 2\n", {}, {.state = true});
  State state = state_of(20);
  for (std::uint32_t i = 0; i < 20; ++i) state.id.push_back(19 - i);
  const std::vector<BodyNumbers> drawn = drawn_bodies(scene);
  const Simulation of_code(scene, state);
  adopt_state(scene, state);
  const Simulation simulation(scene, state);
  for (const Simulation* each : {&of_code, &simulation}) {
    const OwnBodies own = each->own_bodies();
    ASSERT_EQ(own.length.size(), 20u);
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_EQ(own.length[i], drawn[i].length);
      EXPECT_EQ(own.mass[i], drawn[i].mass);
      EXPECT_EQ(own.inertia[i], drawn[i].inertia);
    }
  }
}

// A mass follows from the length that is given, and the moment of inertia from both.
TEST(Sizes, FollowFromTheArraysThatAreGiven) {
  const Scene scene = parsed(head + lengths + "mass.density = 2\n", {}, {.state = true});
  State state = state_of(20);
  state.own_bodies.length.assign(20, 1.5);
  state.own_bodies.length[7] = 3;
  const OwnBodies own = Simulation(scene, state).own_bodies();
  EXPECT_EQ(own.mass[0], 3);
  EXPECT_EQ(own.mass[7], 6);
  EXPECT_EQ(own.inertia[7], 6.0 * 9 / 12);

  Scene rods = parsed("needles.box = 20\nuntil.time = 1\n", {}, {.state = true});
  state.own_bodies.diameter.assign(20, 0.25);
  const OwnBodies of_rods = Simulation(rods, state).own_bodies();
  EXPECT_EQ(of_rods.inertia[7], 9 / (2 * homogeneous_k(3, 0.25)));
}

TEST(Sizes, OfAStateMustBeOneForEachNeedle) {
  const Scene scene = parsed("needles.box = 20\nuntil.time = 1\n", {}, {.state = true});
  const auto refusal = [&](const auto& edit) {
    State state = state_of(20);
    edit(state.own_bodies);
    return test::refusal([&] { Simulation(scene, state); });
  };
  const auto all = [](double value) { return std::vector<double>(20, value); };
  EXPECT_EQ(refusal([&](OwnBodies& own) {
              own.mass = {1, 2};
            }),
            "state: 2 rows of mass: expected 20");
  EXPECT_EQ(refusal([&](OwnBodies& own) {
              own.length = all(1);
              own.length[3] = -1;
            }),
            "state: needle 3: length = -1: expected from 1e-06 to 1e+06, or 0");
  EXPECT_EQ(refusal([&](OwnBodies& own) {
              own.mass = all(1);
              own.mass[4] = std::numeric_limits<double>::infinity();
            }),
            "state: needle 4: mass = inf: expected from 1e-100 to 1e+100");
  EXPECT_EQ(
      refusal([&](OwnBodies& own) {
        own.diameter = all(0.5);
        own.length = all(1);
        own.length[5] = 0;
      }),
      "state: needle 5: length = 0: expected a number above 0, as others of its species have");
  EXPECT_TRUE(
      test::contains(refusal([&](OwnBodies& own) {
                       own.inertia = all(0.1);
                       own.inertia[6] = 1e30;
                     }),
                     "state: needle 6: inertia = 1e+30: expected one with which k = m L^2"));
}

TEST(Sizes, OfAStateOfEqualBodiesCannotBeDrawn) {
  Scene scene = parsed(head + lengths, {}, {.state = true});
  State state = state_of(20);
  state.bodies = {.length = {1}, .diameter = {0}, .mass = {1}, .k = {6}};
  EXPECT_EQ(
      test::refusal([&] { adopt_state(scene, state); }),
      "s.toml: line 6: species.length.distribution = \"lognormal\": expected 1, as in the state");
}

// Whatever the scene draws, a state keeps the bodies that it has.
TEST(Sizes, OfAStateAreKept) {
  const Scene scene = parsed(head + lengths);
  const State drawn = draw_initial_state(scene);
  Scene again = parsed(head + lengths + "mass = 2\n", {"needles.seed=7"}, {.state = true});
  State state = drawn;
  adopt_state(again, state);
  EXPECT_EQ(Simulation(again, state).own_bodies().length, drawn.own_bodies.length);
  EXPECT_EQ(Simulation(again, state).own_bodies().mass, drawn.own_bodies.mass);
}

}  // namespace
}  // namespace needlework
