// Scenes with [[walls]] and [forces].
#include <gtest/gtest.h>

#include <array>
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
    "motion.phase, motion.velocity, motion.stop_at, motion.tangential";
const std::string motion_keys =
    "expected {amplitude = ..., frequency = ..., phase = ..., velocity = ..., stop_at = ..., "
    "tangential = ...}";

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
      {both + "motion = {}", "line 7: walls.motion = {}: " + motion_keys},
      {both + "motion = 2", "line 7: walls.motion = 2: " + motion_keys},
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

TEST(Walls, MoveAsTheSceneSays) {
  const Scene piston = parse_scene(
      with_walls(wall("z", "low", "motion.velocity = 0.25\n") +
                 wall("z", "high", "motion = { velocity = -0.5, stop_at = 10 }\nepsilon = 0.9\n")),
      "s.toml");
  ASSERT_EQ(piston.walls.size(), 2u);
  EXPECT_EQ(piston.walls[0].motion->velocity, 0.25);
  EXPECT_FALSE(piston.walls[0].motion->stop_at || piston.walls[0].motion->tangential);
  EXPECT_EQ(piston.walls[0].motion->amplitude, 0);
  EXPECT_EQ(piston.walls[1].motion->velocity, -0.5);
  EXPECT_EQ(piston.walls[1].motion->stop_at, 10);
  EXPECT_EQ(piston.walls[1].epsilon, 0.9);
  EXPECT_TRUE(piston.has_moving_walls());
  const Scene belts = parse_scene(
      with_walls(wall("y", "both", "temperature = 2\nmotion.tangential = [1.5, -3]\n")), "s.toml");
  EXPECT_EQ(belts.walls[0].motion->tangential, (std::array{1.5, -3.0}));
  EXPECT_EQ(belts.walls[0].temperature, 2);
  EXPECT_FALSE(belts.has_moving_walls() || belts.walls[0].motion->velocity);
  EXPECT_EQ(parse_scene(with_walls(both), "s.toml",
                        Overrides{"walls.motion.velocity=-2", "until.time=0.1"})
                .walls[0]
                .motion->velocity,
            -2);
}

TEST(BadWalls, HaveOneKindOfMotion) {
  const std::string not_thermal =
      "expected walls.temperature besides: the impulse of a smooth wall is along its normal, so "
      "that its own motion in its plane changes nothing";
  const std::string alone =
      "expected none beside amplitude or velocity: walls that slide in their plane are thermal, "
      "and those do not move along their normal";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"temperature = 1\nmotion.velocity = 0.5",
       "line 8: walls.motion.velocity = 0.5: expected none beside temperature: thermal walls do "
       "not "
       "move along their normal"},
      {"motion = { velocity = 0.5, amplitude = 0.1, frequency = 1 }",
       "line 7: walls.motion.velocity = 0.5: expected none beside amplitude: a wall moves at "
       "constant velocity or shakes"},
      {"motion = { velocity = 0.5, amplitude = 0, frequency = 1 }",
       "line 7: walls.motion.velocity = 0.5: expected none beside amplitude: a wall moves at "
       "constant velocity or shakes"},
      {"motion.tangential = [1, 0]", "line 7: walls.motion.tangential = [1, 0]: " + not_thermal},
      {"epsilon = 0.5\nmotion.tangential = [1, 0]",
       "line 8: walls.motion.tangential = [1, 0]: " + not_thermal},
      {"motion = { tangential = [1, 0], velocity = 0.5 }",
       "line 7: walls.motion.tangential = [1, 0]: " + alone},
      {"motion = { tangential = [1, 0], amplitude = 0.1, frequency = 1 }",
       "line 7: walls.motion.tangential = [1, 0]: " + alone},
      {"motion.stop_at = 3",
       "walls.motion.amplitude is missing: expected a length >= 0 (at most 1e9)"},
      {"motion = { stop_at = 3, amplitude = 0.1, frequency = 1 }",
       "line 7: walls.motion.stop_at = 3: expected a velocity besides, other than 0"},
      {"motion = { stop_at = 3, velocity = 0 }",
       "line 7: walls.motion.stop_at = 3: expected a velocity besides, other than 0"},
      {"motion = { stop_at = 3, velocity = 0.5 }",
       "line 7: walls.motion.stop_at = 3: expected side \"low\" or \"high\": two walls cannot stop "
       "at one place"},
      {"motion.phase = 1",
       "walls.motion.amplitude is missing: expected a length >= 0 (at most 1e9)"},
      {"motion.velocity = inf",
       "line 7: walls.motion.velocity = inf: expected a velocity along the positive axis (at most "
       "1e100)"},
      {"motion = { velocity = 1, stop_at = nan }",
       "line 7: walls.motion.stop_at = nan: expected a coordinate (from -1e9 to 1e9)"},
      {"motion.tangential = 1",
       "line 7: walls.motion.tangential = 1: expected [a, b], a velocity along each of the two "
       "other "
       "axes (at most 1e100)"},
      {"motion.tangential = [1, 2, 3]",
       "line 7: walls.motion.tangential = [1, 2, 3]: expected [a, b], a velocity along each of the "
       "two other axes (at most 1e100)"},
      {"motion.velocit = 1",
       "line 7: walls.motion.velocit = 1: " + one_of_walls + ", did you mean motion.velocity?"},
  };
  for (const auto& [more, expected] : cases)
    EXPECT_EQ(message(with_walls(both + more)), "s.toml: " + expected) << more;
}

TEST(BadWalls, StopBehindWhereTheyStart) {
  struct Case {
    const char* side;
    double velocity, stop;
    std::string expected;
  };
  for (const Case& c : {Case{"low", 0.5, 2, ""},
                        {"low", -0.5, -2, ""},
                        {"high", -0.5, 9, ""},
                        {"high", 0.5, 13, ""},
                        {"low", 0.5, 0, ""},  // where one that goes on from a file has come to rest
                        {"low", 0.5, -2, "at or above 0, from which the wall moves up"},
                        {"low", -0.5, 2, "at or below 0, from which the wall moves down"},
                        {"high", -0.5, 13, "at or below 12, from which the wall moves down"},
                        {"high", 0.5, 11, "at or above 12, from which the wall moves up"}}) {
    const std::string moving = wall("z", c.side,
                                    "motion = { velocity = " + std::to_string(c.velocity) +
                                        ", stop_at = " + std::to_string(c.stop) + " }\n");
    const std::string other = wall("z", std::string(c.side) == "low" ? "high" : "low");
    const std::string found = message(with_walls(moving + other));
    if (c.expected.empty()) {
      EXPECT_EQ(found, "no error") << moving;
    } else {
      EXPECT_TRUE(test::contains(found, "walls.motion.stop_at = ")) << found;
      EXPECT_TRUE(test::contains(found, ": expected a place " + c.expected)) << found;
    }
  }
}

// At the time of the scene's end they need room for the longest body, with the amplitude of one
// that shakes.
TEST(BadWalls, MeetBeforeTheEnd) {
  const auto until = [](const std::string& time, const std::string& walls) {
    return message("needles = { count = 10, box = 12 }\nuntil.time = " + time + "\n" + walls);
  };
  const auto expected = [](const char* given, const char* time, const char* near) {
    return std::string("s.toml: line 2: until.time = ") + given + ": expected a time before " +
           time + ", when the walls along z have come as near as " + near +
           ", the extent of the longest body";
  };
  const std::string closing =
      wall("z", "low", "motion.velocity = 0.5\n") + wall("z", "high", "motion.velocity = -1.5\n");
  EXPECT_EQ(until("5.25", closing), "no error");
  EXPECT_EQ(until("5.75", closing), expected("5.75", "5.5", "1"));
  EXPECT_EQ(
      message("needles.count = 10\nneedles.box = 12\nuntil.collisions_per_needle = 9\n" + closing),
      "no error");  // known to end there
  const std::string stops = wall("z", "low", "motion = { velocity = 0.5, stop_at = 1 }\n") +
                            wall("z", "high", "motion = { velocity = -1.5, stop_at = 3 }\n");
  EXPECT_EQ(until("1000", stops), "no error");
  const std::string shaken = wall("z", "low", "motion = { amplitude = 0.5, frequency = 1 }\n") +
                             wall("z", "high", "motion.velocity = -1\n");
  EXPECT_EQ(until("10.25", shaken), "no error");
  EXPECT_TRUE(test::contains(until("10.75", shaken), "as near as 1.5"));
  const std::string rods =
      "needles.box = 12\nuntil.time = 9.5\n"
      "species = [{ name = 'a', count = 1, length = 2, diameter = 0.75 }]\n";
  const std::string from_above = wall("z", "low") + wall("z", "high", "motion.velocity = -1\n");
  EXPECT_EQ(message(rods + from_above), expected("9.5", "9.25", "2.75"));
  EXPECT_EQ(message(rods + from_above, {"until.time=9.2"}), "no error");
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
