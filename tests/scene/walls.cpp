// Scenes with [[walls]] and [forces].
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "tests/scene/message.h"

namespace needlework {
namespace {

using test::message;
using test::Overrides;

// Lines 1 to 3, so that more begins at line 4.
const std::string unwalled = R"(needles = { count = 10, box = 12 }
until.time = 5

)";
const std::string one_of_walls =
    "expected one of axis, side, epsilon, temperature, motion.amplitude, motion.frequency, "
    "motion.phase";

// Walls as lines of TOML, from line 4 on.
std::string with_walls(const std::string& walls) { return unwalled + walls; }
const std::string both = "[[walls]]\naxis = 'z'\nside = 'both'\n";

TEST(Walls, HaveDefaults) {
  const Scene scene = parse_scene(with_walls(both), "s.toml");
  ASSERT_EQ(scene.walls.size(), 1u);
  const Scene::Wall& wall = scene.walls.front();
  EXPECT_EQ(wall.axis, "z");
  EXPECT_EQ(wall.side, "both");
  EXPECT_EQ(wall.epsilon, 1);
  EXPECT_FALSE(wall.temperature || wall.motion);
  EXPECT_EQ(scene.forces.gravity, (std::array<double, 3>{}));
  EXPECT_TRUE(parse_scene(unwalled, "s.toml").walls.empty());
}

TEST(Walls, HaveWhatTheSceneSays) {
  for (const std::string motion : {"motion = { amplitude = 0.25, frequency = 2, phase = 1.5 }",
                                   "motion.phase = 1.5\nmotion.frequency = 2\n"
                                   "motion.amplitude = 0.25",
                                   "[walls.motion]\nphase = 1.5\nfrequency = 2\n"
                                   "amplitude = 0.25"}) {
    const Scene scene = parse_scene(
        with_walls("forces.gravity = [0, 0, -2]\n" + both + "epsilon = 0.5\n" + motion), "s.toml");
    ASSERT_EQ(scene.walls.size(), 1u) << motion;
    const Scene::Wall& wall = scene.walls.front();
    EXPECT_EQ(wall.epsilon, 0.5);
    ASSERT_TRUE(wall.motion);
    EXPECT_EQ(wall.motion->amplitude, 0.25);
    EXPECT_EQ(wall.motion->frequency, 2);
    EXPECT_EQ(wall.motion->phase, 1.5);
    EXPECT_EQ(scene.forces.gravity, (std::array{0.0, 0.0, -2.0}));
    EXPECT_NE(scene.places.at("walls.motion.phase").find("walls.motion.phase = 1.5"),
              std::string::npos);
  }
  EXPECT_EQ(parse_scene(with_walls(both + "temperature = 3"), "s.toml").walls[0].temperature, 3);
}

TEST(Walls, CanBeOverridden) {
  const std::string two =
      with_walls("[[walls]]\nside = 'low'\naxis = 'z'\n[[walls]]\naxis = 'z'\nside = 'high'\n");
  const Scene scene = parse_scene(
      two, "s.toml",
      Overrides{"walls.z-high.epsilon=0.5", "walls.z-low.motion.amplitude=0.1",
                "walls.z-low.motion={frequency = 2, phase = 3}", "forces.gravity=[0, 0, -1]"});
  EXPECT_EQ(scene.walls.at(0).epsilon, 1);
  EXPECT_EQ(scene.walls.at(1).epsilon, 0.5);
  ASSERT_TRUE(scene.walls[0].motion);
  EXPECT_FALSE(scene.walls[1].motion);
  EXPECT_EQ(scene.walls[0].motion->amplitude, 0.1);
  EXPECT_EQ(scene.walls[0].motion->frequency, 2);
  EXPECT_EQ(scene.walls[0].motion->phase, 3);
  EXPECT_EQ(scene.forces.gravity[2], -1);
  // The name may be left out where there is one.
  EXPECT_EQ(parse_scene(with_walls(both), "s.toml",
                        Overrides{"walls.motion.amplitude=0.1", "walls.motion.frequency=3"})
                .walls[0]
                .motion->frequency,
            3);
  EXPECT_EQ(message(two, {"walls.epsilon=0.5"}),
            "--set walls.epsilon=0.5: expected walls.NAME.epsilon with one of the names z-low, "
            "z-high");
  EXPECT_EQ(message(two, {"walls.x-low.motion.phase=1"}),
            "--set walls.x-low.motion.phase=1: expected walls.NAME.motion.phase with one of the "
            "names z-low, z-high");
  EXPECT_EQ(message(two, {"walls.z-low.motion.amplitude=-1"}),
            "--set walls.z-low.motion.amplitude=-1: expected a length >= 0 (at most 1e9)");
  EXPECT_EQ(
      message(two, {"walls.z-low.motion.amplitud=1"}),
      "--set walls.z-low.motion.amplitud=1: " + one_of_walls + ", did you mean motion.amplitude?");
  EXPECT_EQ(message(unwalled, {"walls.z-low.epsilon=1"}),
            "--set walls.z-low.epsilon=1: expected a scene with an entry [[walls]]");
}

TEST(BadWalls, AreRefused) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[walls]\naxis = 'z'", "line 4: [walls]: expected [[walls]], in double brackets"},
      {"[[walls]]\nside = 'low'", R"(walls.axis is missing: expected "x", "y" or "z")"},
      {"[[walls]]\naxis = 'z'", R"(walls.side is missing: expected "low", "high" or "both")"},
      {both + "[[walls]]\naxis = 'x'",
       R"(walls.side of the entry 2 is missing: expected "low", "high" or "both")"},
      {"[[walls]]\naxis = 'w'", R"(line 5: walls.axis = 'w': expected "x", "y" or "z")"},
      {"[[walls]]\nside = 'top'",
       R"(line 5: walls.side = 'top': expected "low", "high" or "both")"},
      {both + "epsilon = 1.5", "line 7: walls.epsilon = 1.5: expected a number from 0 to 1"},
      {both + "epsilon = nan", "line 7: walls.epsilon = nan: expected a number from 0 to 1"},
      {both + "temperature = 0",
       "line 7: walls.temperature = 0: expected a temperature > 0 (from 1e-200 to 1e200)"},
      {both + "motion = { amplitude = -1, frequency = 1 }",
       "line 7: walls.motion.amplitude = -1: expected a length >= 0 (at most 1e9)"},
      {both + "motion = { amplitude = inf, frequency = 1 }",
       "line 7: walls.motion.amplitude = inf: expected a length >= 0 (at most 1e9)"},
      {both + "motion = { amplitude = 1, frequency = 0 }",
       "line 7: walls.motion.frequency = 0: expected a number > 0 of cycles per time (from 1e-100 "
       "to 1e100)"},
      {both + "motion = { amplitude = 1, frequency = 1, phase = nan }",
       "line 7: walls.motion.phase = nan: expected an angle in radians, from -1000 to 1000"},
      {both + "motion = { frequency = 1 }",
       "walls.motion.amplitude is missing: expected a length >= 0 (at most 1e9)"},
      {both + "motion = { amplitude = 1 }",
       "walls.motion.frequency is missing: expected a number > 0 of cycles per time (from 1e-100 "
       "to 1e100)"},
      {both + "motion = {}",
       "line 7: walls.motion = {}: expected {amplitude = ..., frequency = ..., phase = ...}"},
      {both + "motion = 2",
       "line 7: walls.motion = 2: expected {amplitude = ..., frequency = ..., phase = ...}"},
      {both + "motion = { ampltude = 2 }",
       "line 7: walls.motion.ampltude = 2: " + one_of_walls + ", did you mean motion.amplitude?"},
      {both + "temprature = 2",
       "line 7: walls.temprature = 2: " + one_of_walls + ", did you mean temperature?"},
      {"forces.gravity = 1",
       "line 4: forces.gravity = 1: expected an array of three accelerations (each 0, or from "
       "1e-100 to 1e100)"},
      {"forces.gravity = [0, 0, nan]",
       "line 4: forces.gravity = [0, 0, nan]: expected an array of three accelerations (each 0, or "
       "from 1e-100 to 1e100)"},
      {"forces.gravity = [0, 0, 1e-200]",
       "line 4: forces.gravity = [0, 0, 1e-200]: expected an array of three accelerations (each 0, "
       "or from 1e-100 to 1e100)"},
  };
  for (const auto& [walls, expected] : cases)
    EXPECT_EQ(message(with_walls(walls)), "s.toml: " + expected) << walls;
}

}  // namespace
}  // namespace needlework
