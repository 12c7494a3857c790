// Scenes of rods of finite width: what they mean, and which are refused.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/scene/own_bodies.h"
#include "tests/scene/message.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

Scene rods(const std::string& species) {
  return parse_scene("needles.box = 30\nuntil.time = 1\n" + species, "s.toml");
}

std::string entry(const std::string& name, const std::string& keys) {
  return "[[species]]\nname = \"" + name + "\"\ncount = 2\n" + keys + "\n";
}

TEST(SceneOfRods, HasHomogeneousRods) {
  // m L^2 / (2 I) of homogeneous rods of L = D, 5 D and 10 D
  for (const auto& [length, k] :
       {std::pair("1", 1.652893), std::pair("5", 4.544240), std::pair("10", 5.231750)}) {
    const Scene scene = rods(entry("a", "diameter = 1\nlength = " + std::string(length)));
    EXPECT_NEAR(scene.composition()[0].k, k, 1e-6);
  }
  const Scene brief =
      parse_scene("needles = { count = 2, box = 9, diameter = 0.2 }\nuntil.time = 1", "s.toml");
  EXPECT_NEAR(brief.composition()[0].k, 4.544240, 1e-6);
  EXPECT_EQ(brief.composition()[0].diameter, 0.2);
}

TEST(SceneOfRods, TakesAnInertiaInPlaceOfK) {
  const Scene scene = rods(entry("a", "length = 2\nmass = 3\ninertia = 0.5"));
  EXPECT_EQ(scene.composition()[0].k, 12);
  EXPECT_EQ(scene.composition()[0].inertia(), 0.5);
}

TEST(SceneOfRods, HasSpheresThatDoNotTurn) {
  const Species sphere = rods(entry("a", "length = 0\ndiameter = 2")).composition()[0];
  EXPECT_FALSE(sphere.turns());
  EXPECT_EQ(sphere.inertia(), 0);
  EXPECT_EQ(sphere.t_rot, 0);
  EXPECT_NEAR(sphere.volume(), 4.18879, 1e-5);
}

// One with a rough partner, itself among them.
TEST(SceneOfRods, HasRoughSpheresThatTurn) {
  const auto composition = [](const std::string& keys, const std::string& rest = "") {
    return rods(entry("a", "length = 0\ndiameter = 2\nmass = 3\nt_rot = 5\n" + keys) +
                entry("b", "length = 0\ndiameter = 1") + entry("rods", "diameter = 1") +
                "[[pairs]]\nbetween = ['a', 'a']\nbeta = 0.5\n" + rest)
        .composition();
  };
  const Composition homogeneous = composition("");
  EXPECT_TRUE(homogeneous[0].turns());
  EXPECT_FALSE(homogeneous[0].has_axis());
  EXPECT_EQ(homogeneous[0].q, 0.4);
  EXPECT_EQ(homogeneous[0].inertia(), 0.4 * 3 * 4 / 4);
  EXPECT_EQ(homogeneous[0].t_rot, 5);
  EXPECT_FALSE(homogeneous[1].turns());
  EXPECT_EQ(homogeneous[1].t_rot, 0);
  EXPECT_EQ(homogeneous.turning_share(), (1.5 * 2 + 2) / 6);
  EXPECT_EQ(composition("inertia = 1.5")[0].q, 0.5);
  EXPECT_EQ(composition("inertia = 2")[0].q, 2.0 / 3);
  const Composition both = composition("", "[[pairs]]\nbetween = ['a', 'b']\nbeta = -0.5\n");
  EXPECT_EQ(both[1].q, 0.4);
  EXPECT_EQ(both[1].t_rot, 1);
}

TEST(SceneOfRods, HasRoughSpheresThatDiffer) {
  const Scene scene = parse_scene(
      "needles.box = 30\nuntil.time = 1\ncollisions.beta = 0\n[[species]]\n"
      "name = 'a'\ncount = 50\nlength = 0\ndiameter.distribution = 'lognormal'\n"
      "diameter.mean = 1\ndiameter.width = 0.2\nmass.density = 2\n",
      "s.toml");
  for (const BodyNumbers& body : drawn_bodies(scene))
    EXPECT_EQ(body.inertia, 0.4 * body.mass * (body.diameter * body.diameter) / 4);
  const Species all = scene.composition()[0];
  EXPECT_NEAR(all.inertia(), all.sizes->inertia.mean, 1e-15);
}

// Beside what invalid_scenes.json has.
TEST(SceneOfRods, IsRefusedWhereALengthIsThatOfRods) {
  const std::string refused = test::refusal([] { rods(entry("a", "length = 20\ndiameter = 1")); });
  EXPECT_TRUE(test::contains(refused, "42.21 (2.01 rod lengths)"));
}

}  // namespace
}  // namespace needlework
