#include "src/picture/walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/picture/needle_picture.h"
#include "src/picture/stroke_font.h"
#include "tests/picture/states.h"
#include "tests/support/contains.h"

namespace needlework::picture {
namespace {

Scene::Wall wall_at(const char* axis, const char* side) {
  Scene::Wall wall;
  wall.axis = axis;
  wall.side = side;
  return wall;
}

Scene::Wall shaken(const char* axis, const char* side, double phase = 0) {
  Scene::Wall wall = wall_at(axis, side);
  wall.motion = Scene::WallMotion{.amplitude = 0.5, .frequency = 0.25, .phase = phase};
  return wall;
}

State confined(double box, const std::vector<std::array<double, 3>>& centres) {
  State state = needles_at(box, centres);
  state.periodic = {true, true, false};
  return state;
}

// Along x, without perspective: y to the right, z upwards. Needles point along x.
NeedlePicture from_the_side(std::vector<Scene::Wall> walls) {
  NeedlePicture settings;
  settings.colour = "none";
  settings.camera = {0, 0, true};
  settings.walls = std::move(walls);
  return settings;
}

std::vector<std::string> words_of(const Drawing& drawing) {
  std::vector<std::string> words;
  for (const Words& each : drawing.words) words.push_back(each.text);
  return words;
}

// Heights of the level lines of this colour in the picture, each once, from above [pixels].
std::vector<double> levels(const Drawing& drawing, Colour colour) {
  std::vector<double> found;
  for (const Stroke& stroke : drawing.strokes) {
    const bool is_level = std::abs(stroke.from.y - stroke.to.y) < 1e-9;
    if (is_level && hex(stroke.colour) == hex(colour)) found.push_back(stroke.from.y);
  }
  std::ranges::sort(found);
  const auto close = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  found.erase(std::unique(found.begin(), found.end(), close), found.end());
  return found;
}

TEST(Walls, AreWhereTheirMotionHasBroughtThem) {
  const std::vector walls{shaken("z", "low"), shaken("z", "high", 1.0), wall_at("x", "high")};
  State state;
  state.box = {4, 5, 6};
  for (const double time : {0.0, 1.0, 7.3, 1e6 + 3}) {
    const auto surfaces = surfaces_of(walls, state, time);
    ASSERT_EQ(surfaces.size(), 3);
    const double angle = 2 * M_PI * 0.25 * std::fmod(time, 4.0);
    EXPECT_NEAR(surfaces[0].place, 0.5 * std::sin(angle), 1e-9) << time;
    EXPECT_NEAR(surfaces[1].place, 6 + 0.5 * std::sin(angle + 1), 1e-9) << time;
    EXPECT_EQ(surfaces[2].place, 4);
  }
  const auto unknown = surfaces_of(walls, state, {});
  EXPECT_EQ(unknown[0].place, 0);
  EXPECT_EQ(unknown[1].place, 6);
}

TEST(Walls, ThatDrawVelocitiesAreThermalAndThatMoveAreMoving) {
  Scene::Wall thermal = wall_at("y", "low");
  thermal.temperature = 2;
  Scene::Wall still = shaken("y", "high");
  still.motion->amplitude = 0;
  const auto surfaces =
      surfaces_of(std::vector{thermal, still, shaken("z", "low")}, {4, 4, 4}, 0.0);
  EXPECT_EQ(surfaces[0].kind, WallKind::thermal);
  EXPECT_EQ(surfaces[1].kind, WallKind::resting);
  EXPECT_EQ(surfaces[2].kind, WallKind::moving);
}

TEST(Walls, AreDescribedByWhatTheyDo) {
  Scene::Wall wall = wall_at("z", "low");
  wall.epsilon = 0.95;
  EXPECT_EQ(description_of(wall), "low z (wall, restitution 0.95)");
  wall.motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 2};
  EXPECT_EQ(description_of(wall),
            "low z (moving wall, amplitude 0.1, frequency 2, restitution 0.95)");
  wall.motion.reset();
  wall.temperature = 2.5;
  EXPECT_EQ(description_of(wall), "low z (thermal wall, temperature 2.5)");
}

TEST(Walls, LeaveSidesOppositeToThemOpen) {
  const auto surfaces = surfaces_of(
      std::vector{wall_at("z", "low"), wall_at("x", "low"), wall_at("x", "high")}, {4, 4, 4}, {});
  EXPECT_TRUE(is_open(surfaces, 2, true));
  EXPECT_FALSE(is_open(surfaces, 2, false));
  EXPECT_FALSE(is_open(surfaces, 0, true));
  EXPECT_FALSE(is_open(surfaces, 1, true));  // periodic
}

TEST(RegionOfAPicture, ReachesToTheHighestCentreAndToWallsBeyondTheBox) {
  State state = confined(4, {{1, 1, 9.5}, {7, -3, 1}});
  Region region = region_of(state, surfaces_of(std::vector{shaken("z", "low")}, state, 3.0));
  EXPECT_EQ(region.low, (Vector{0, 0, -0.5}));
  EXPECT_EQ(region.high, (Vector{4, 4, 9.5}));
  state.periodic = {true, true, true};
  region = region_of(state, {});
  EXPECT_EQ(region.low, (Vector{0, 0, 0}));
  EXPECT_EQ(region.high, (Vector{4, 4, 4}));
}

TEST(NeedlePictures, ShowWallsAtTheirHeight) {
  const Colour moving{70, 190, 160}, resting{150, 162, 190};
  NeedlePicture settings = from_the_side({shaken("z", "low"), wall_at("z", "high")});
  settings.time = 1;  // the floor is 0.5 above its middle
  const State state = confined(4, {{2, 2, 2}});
  const Drawing drawing = drawing_of(state, settings);
  const auto floor = levels(drawing, moving), ceiling = levels(drawing, resting);
  // The first level of each is in the key above the picture.
  ASSERT_EQ(floor.size(), 2);
  ASSERT_EQ(ceiling.size(), 2);
  // The box and half a needle on each side fill the height that key, legend and edges leave.
  const double scale = (832 - 14 - 26 - 76) / 5.0;
  EXPECT_NEAR(floor[1] - ceiling[1], 3.5 * scale, 1e-6);
  EXPECT_EQ(words_of(drawing),
            (std::vector<std::string>{"time 1", "1 needle", "wall", "moving wall"}));
  EXPECT_TRUE(test::contains(
      drawing.description,
      "in a box of 4 by 4 by 4, not periodic along z, walls: low z (moving wall, "
      "amplitude 0.5, frequency 0.25, restitution 1), high z (wall, restitution 1) at"));
  for (const Words& words : drawing.words) EXPECT_TRUE(can_be_written(words.text)) << words.text;
}

TEST(NeedlePictures, ShowWallsBehindNeedlesAsLatticesAndOthersAsOutlines) {
  const State state = confined(4, {{2, 2, 2}});
  const auto before_and_after = [&](const char* side, double elevation) {
    NeedlePicture settings = from_the_side({wall_at("z", side)});
    settings.camera = {30, elevation, false};
    const Drawing drawing = drawing_of(state, settings);
    const auto needle = std::ranges::find_if(drawing.strokes, [](auto& s) { return s.halo > 0; });
    return std::pair(needle - drawing.strokes.begin(), drawing.strokes.end() - needle - 1);
  };
  // 8 edges of the box, which is open at the other end of z, and a line of the key, are besides.
  const std::ptrdiff_t with_lattice = 2 * 9, outline = 4;
  const auto floor = before_and_after("low", 20), from_below = before_and_after("low", -20);
  EXPECT_EQ(floor.first + floor.second, 8 + with_lattice + 1);
  EXPECT_EQ(from_below.first + from_below.second, 8 + outline + 1);
  EXPECT_GE(floor.first, with_lattice);
  EXPECT_GE(from_below.second, outline + 1);
  EXPECT_EQ(before_and_after("high", -20).first, floor.first);
}

TEST(NeedlePictures, ShowNeedlesAboveAnOpenBoxInside) {
  const Drawing drawing =
      drawing_of(confined(4, {{2, 2, 2}, {2, 2, 30}}), from_the_side({wall_at("z", "low")}));
  for (const Stroke& stroke : drawing.strokes) {
    EXPECT_GE(std::min(stroke.from.y, stroke.to.y), 0);
    EXPECT_LE(std::max(stroke.from.y, stroke.to.y), 832);
  }
}

TEST(NeedlePictures, LeaveCentresAlongWalledAxesWhereTheyAre) {
  // 4.2 is beyond the open side of a box of 4, not inside of it at 0.2.
  const auto heights = [](const State& state, std::vector<Scene::Wall> walls) {
    std::vector<double> out;
    for (const Stroke& stroke : drawing_of(state, from_the_side(std::move(walls))).strokes) {
      if (stroke.halo > 0) out.push_back(stroke.from.y);
    }
    std::ranges::sort(out);
    return out;
  };
  const std::vector<std::array<double, 3>> centres{{2, 2, 1}, {2, 2, 4.2}};
  const auto walled = heights(confined(4, centres), {wall_at("z", "low")});
  EXPECT_NEAR(walled[1] - walled[0], 3.2 * (832 - 14 - 26 - 76) / 5.2, 1e-6);
  const auto periodic = heights(needles_at(4, centres), {});
  EXPECT_NEAR(periodic[1] - periodic[0], 0.8 * (832 - 14 - 76) / 5, 1e-6);
}

}  // namespace
}  // namespace needlework::picture
