// States that are given: needles lie inside the walls.
#include <gtest/gtest.h>

#include <string>

#include "needlework/error.h"
#include "src/engine/initial_gas.h"

namespace needlework {
namespace {

// Three needles along z, the last of which is centred at this height.
State state_at(double z) {
  State state;
  state.box = {4, 4, 3};
  state.position = {{1, 1, 1.5}, {2, 2, 1.5}, {3, 3, z}};
  state.orientation = {{0, 0, 1}, {0, 0, 1}, {0, 0, -2}};  // need not be unit vectors
  state.velocity = state.angular_velocity = {{}, {}, {}};
  state.id = {4, 9, 6};
  return state;
}

Scene scene_with(double amplitude) {
  Scene scene;
  for (const char* side : {"low", "high"}) {
    Scene::Wall wall;
    wall.axis = "z";
    wall.side = side;
    wall.motion = {.amplitude = amplitude, .frequency = 1, .phase = 1.5707963267948966};
    scene.walls.push_back(wall);
  }
  return scene;
}

std::string complaint(const Scene& scene, double z) {
  try {
    make_gas(scene, state_at(z));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(GivenState, LiesInsideTheWalls) {
  for (const double amplitude : {0.0, 0.25}) {  // at t = 0 both surfaces are so much higher
    const Scene scene = scene_with(amplitude);
    const std::string where =
        scene.walls[0].motion ? ", where walls.motion.phase puts it at the start" : "";
    EXPECT_EQ(complaint(scene, amplitude + 1.5), "none");
    // A tip may be beyond a surface by rounding.
    EXPECT_EQ(complaint(scene, amplitude + 0.5), "none");
    EXPECT_EQ(complaint(scene, amplitude + 2.5), "none");
    EXPECT_EQ(complaint(scene, amplitude + 0.5 - 0x1p-42), "none");
    EXPECT_NE(complaint(scene, amplitude + 0.5 - 0x1p-39), "none");
    EXPECT_EQ(
        complaint(scene, amplitude + 0.375),
        "state: needle 6: a tip is 0.125 beyond the wall z-low: expected both inside" + where);
    EXPECT_EQ(
        complaint(scene, amplitude + 2.75),
        "state: needle 6: a tip is 0.25 beyond the wall z-high: expected both inside" + where);
  }
  EXPECT_EQ(complaint(Scene{}, 0.375), "none");
}

TEST(GivenState, HasNoFixedNeedleWhereAWallMovesTo) {
  Scene scene;
  scene.species = {{.name = "free", .count = 2},
                   {.name = "still", .count = 1, .fixed = true}};  // needle 9, at z from 1 to 2
  const auto with = [&](const char* side, const Scene::WallMotion& motion) {
    scene.walls = {{.axis = "z", .side = side, .motion = motion}};
    return complaint(scene, 1.5);
  };
  using Motion = Scene::WallMotion;
  EXPECT_EQ(with("low", Motion{.amplitude = 1}), "none");
  EXPECT_EQ(with("low", Motion{.amplitude = 1.25}),
            "walls.motion.amplitude = 1.25: expected one of at most 1, where needle 9 is fixed");
  EXPECT_EQ(with("high", Motion{.amplitude = 1.25}),
            "walls.motion.amplitude = 1.25: expected one of at most 1, where needle 9 is fixed");
  EXPECT_EQ(with("low", Motion{.velocity = -1}), "none");
  EXPECT_EQ(with("high", Motion{.velocity = 1}), "none");
  EXPECT_EQ(with("low", Motion{.velocity = 1, .stop_at = 1}), "none");
  EXPECT_EQ(with("low", Motion{.velocity = 1, .stop_at = 1.25}),
            "walls.motion.stop_at = 1.25: expected one of at most 1, where needle 9 is fixed");
  EXPECT_EQ(with("high", Motion{.velocity = -1, .stop_at = 1.75}),
            "walls.motion.stop_at = 1.75: expected one of at least 2, where needle 9 is fixed");
  EXPECT_EQ(with("low", Motion{.velocity = 1}),
            "walls.motion.velocity = 1: expected a motion.stop_at of at most 1, where needle 9 is "
            "fixed");
}

}  // namespace
}  // namespace needlework
