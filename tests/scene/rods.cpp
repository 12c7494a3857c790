// Scenes of rods of finite width: what they mean, and which are refused.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
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

// Beside what invalid_scenes.json has.
TEST(SceneOfRods, IsRefusedWhereALengthIsThatOfRods) {
  const std::string refused = test::refusal([] { rods(entry("a", "length = 20\ndiameter = 1")); });
  EXPECT_TRUE(test::contains(refused, "42.21 (2.01 rod lengths)"));
}

}  // namespace
}  // namespace needlework
