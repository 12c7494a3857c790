// Scenes with [[walls]] and [forces].
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "tests/scene/message.h"
#include "tests/support/contains.h"

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

TEST(Walls, AreListedByTheirSides) {
  const Scene scene = parse_scene(
      with_walls("forces.gravity = [0, 2, 0]\n[[walls]]\naxis = 'y'\nside = 'high'\n" + both),
      "s.toml");
  const auto sides = scene.wall_sides();
  ASSERT_EQ(sides.size(), 3u);
  const std::size_t walls[] = {0, 1, 1};
  const std::size_t axes[] = {1, 2, 2};
  const bool high[] = {true, false, true};
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(sides[n].entry, walls[n]);
    EXPECT_EQ(sides[n].axis, axes[n]);
    EXPECT_EQ(sides[n].is_high, high[n]);
  }
  EXPECT_EQ(scene.periodic(), (std::array{true, false, false}));
  EXPECT_EQ(parse_scene(unwalled, "s.toml").periodic(), (std::array{true, true, true}));
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
    EXPECT_TRUE(test::contains(scene.places.at("walls.motion.phase"), "walls.motion.phase = 1.5"));
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
      {"[[walls]]\naxis = 'x'\n" + both,
       R"(walls.side is missing: expected "low", "high" or "both")"},
      {"[[walls]]\naxis = 'w'", R"(line 5: walls.axis = 'w': expected "x", "y" or "z")"},
      {"[[walls]]\nside = 'top'",
       R"(line 5: walls.side = 'top': expected "low", "high" or "both")"},
      {both + "motion = { amplitude = -1, frequency = 1 }",
       "line 7: walls.motion.amplitude = -1: expected a length >= 0 (at most 1e9)"},
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

std::string wall(const char* axis, const char* side, const std::string& more = "") {
  return std::string("[[walls]]\naxis = '") + axis + "'\nside = '" + side + "'\n" + more;
}

// Beside those of invalid_scenes.json.
TEST(BadWalls, DoNotGoTogether) {
  const std::string at_rest =
      "expected none beside temperature: a thermal wall is at rest, and epsilon and t_c do not "
      "apply";
  const std::string open =
      "expected \"both\", or a second wall along z, or forces.gravity that points to this one: "
      "needles would leave the box at its open side";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {wall("x", "both") + wall("z", "both") + wall("x", "low"),
       "line 12: walls.side = 'low': expected no second wall at the low edge of x"},
      {wall("x", "both") + wall("z", "both", "temperature = 2\nepsilon = 0.5\n"),
       "line 11: walls.epsilon = 0.5: " + at_rest},
      {wall("z", "high"), "line 6: walls.side = 'high': " + open},
      {"forces.gravity = [0, 0, -1]\n" + wall("z", "high"), "line 7: walls.side = 'high': " + open},
      {"forces.gravity = [0, 0, 1]\n" + wall("z", "low"), "line 7: walls.side = 'low': " + open},
      {"forces.gravity = [1, 0, -1]\n" + wall("z", "low"),
       "line 4: forces.gravity = [1, 0, -1]: expected none along x, which is periodic, or a wall "
       "with a temperature along another axis: thermal walls brake along their face, and without "
       "one all needles would gain speed along x together for ever"},
  };
  for (const auto& [text, expected] : cases)
    EXPECT_EQ(message(with_walls(text)), "s.toml: " + expected) << text;
  for (const std::string& good :
       {wall("z", "low") + wall("z", "high"), wall("x", "both") + wall("y", "both"),
        "forces.gravity = [0, 0, -1]\n" + wall("z", "low"),
        "forces.gravity = [0, 0, 1]\n" + wall("z", "high"),
        "forces.gravity = [1, 0, 1]\n" + wall("z", "both") + wall("x", "high"),
        "forces.gravity = [1, 0, 0]\n" + wall("z", "both", "temperature = 2\n"),
        "forces.gravity = [1, 2, -1]\n" + wall("z", "low", "temperature = 2\n")}) {
    EXPECT_EQ(message(with_walls(good)), "no error") << good;
  }
}

// The gap between two walls needs room for one needle, at all times; a periodic edge for two.
TEST(BadWalls, LeaveNoRoom) {
  const auto of_box = [](const std::string& box, const std::string& walls) {
    return message("needles = { count = 1, box = " + box + " }\nuntil.time = 5\n" + walls);
  };
  const std::string all = wall("x", "both") + wall("y", "both") + wall("z", "both");
  EXPECT_EQ(of_box("1", all), "no error");
  EXPECT_EQ(of_box("[2.01, 2.01, 1]", wall("z", "both")), "no error");
  EXPECT_EQ(of_box("0.99", all),
            "s.toml: line 1: needles.box = 0.99: expected an edge of at least 1 along x, which has "
            "walls (one needle length)");
  EXPECT_EQ(of_box("[2, 2.01, 1]", wall("z", "both")),
            "s.toml: line 1: needles.box = [2, 2.01, 1]: expected edges of at least 2.01 along "
            "periodic axes (2.01 needle lengths)");
  // Two walls, with amplitude, frequency and phase each, and how near they come.
  struct Case {
    const char *low, *high;
    double nearer;
  };
  for (const Case& c : {
           Case{"amplitude = 0.5, frequency = 2", "amplitude = 0.25, frequency = 3", 0.75},
           Case{"amplitude = 0.5, frequency = 2", "amplitude = 0.5, frequency = 2", 0},
           Case{"amplitude = 0.5, frequency = 2", "amplitude = 0.25, frequency = 2", 0.25},
           Case{"amplitude = 0.5, frequency = 2",
                "amplitude = 0.5, frequency = 2, phase = 3.141592653589793", 1},
           Case{"amplitude = 0.3, frequency = 2",
                "amplitude = 0.4, frequency = 2, phase = -1.570796326794897", 0.5},
           Case{"amplitude = 0.3, frequency = 2", "amplitude = 0, frequency = 2", 0.3},
       }) {
    const std::string walls = wall("z", "low", std::string("motion = { ") + c.low + " }\n") +
                              wall("z", "high", std::string("motion = { ") + c.high + " }\n");
    const auto box = [](double edge) { return "[3, 3, " + std::to_string(edge) + "]"; };
    EXPECT_EQ(of_box(box(1 + c.nearer + 1e-5), walls), "no error") << walls;
    EXPECT_NE(of_box(box(1 + c.nearer - 1e-5), walls), "no error") << walls;
  }
  EXPECT_EQ(
      of_box("[3, 3, 1.25]", wall("z", "both", "motion = { amplitude = 0.5, frequency = 1 }\n")),
      "no error");  // both move as one
  EXPECT_EQ(
      of_box("[3, 3, 1.25]", "forces.gravity = [0, 0, -1]\n" +
                                 wall("z", "low", "motion = { amplitude = 0.5, frequency = 1 }\n")),
      "s.toml: line 1: needles.box = [3, 3, 1.25]: expected an edge of at least 1.5 along z, "
      "which has walls (one needle length at all times of their motion)");
  EXPECT_EQ(message("needles.box = [7, 7, 2.9]\nuntil.time = 5\n"
                    "species = [{name = 'a', count = 1, length = 3}]\n" +
                    wall("z", "both")),
            "s.toml: line 1: needles.box = [7, 7, 2.9]: expected an edge of at least 3 along z, "
            "which has walls (one needle length)");
}

TEST(Walls, AreNeededByTheirObservables) {
  EXPECT_EQ(message(unwalled, {"output.observables=['centre_of_mass']"}),
            "--set output.observables=['centre_of_mass']: expected an entry [[walls]] for "
            "centre_of_mass, which is along axes with walls");
}

}  // namespace
}  // namespace needlework
