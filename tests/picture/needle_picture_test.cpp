#include "src/picture/needle_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <utility>
#include <vector>

#include "src/picture/needle_values.h"
#include "src/picture/stroke_font.h"
#include "tests/picture/states.h"
#include "tests/support/contains.h"

namespace needlework::picture {
namespace {

// Strokes of needles: they alone have a halo.
std::vector<Stroke> needles(const Drawing& drawing) {
  std::vector<Stroke> needles;
  for (const Stroke& stroke : drawing.strokes) {
    if (stroke.halo > 0) needles.push_back(stroke);
  }
  return needles;
}

NeedlePicture along_x() {
  NeedlePicture settings;
  settings.camera = {90, 0, true};  // from the y axis: x to the left, z upwards
  return settings;
}

double length(const Stroke& stroke) {
  return std::hypot(stroke.to.x - stroke.from.x, stroke.to.y - stroke.from.y);
}

TEST(NeedlePictures, ShowEachNeedleAndTwelveEdges) {
  NeedlePicture settings;
  settings.colour = "none";
  const Drawing drawing = drawing_of(needles_at(8, {{1, 2, 3}, {4, 4, 4}, {7, 7, 7}}), settings);
  EXPECT_EQ(needles(drawing).size(), 3);
  EXPECT_EQ(drawing.strokes.size(), 3 + 12);
  EXPECT_EQ(drawing_of(needles_at(8, {}), settings).strokes.size(), 12);
}

TEST(NeedlePictures, ShowEachNeedleAsLongAndWideAsItIs) {
  NeedlePicture settings = along_x();
  settings.colour = "none";
  State state = needles_at(8, {{2, 4, 2}, {4, 4, 4}, {6, 4, 6}});
  state.own_bodies.length = {1, 2, 0.5};
  std::vector<Stroke> strokes = needles(drawing_of(state, settings));
  ASSERT_EQ(strokes.size(), 3u);
  EXPECT_NEAR(length(strokes[1]) / length(strokes[0]), 2, 1e-12);
  EXPECT_NEAR(length(strokes[2]) / length(strokes[0]), 0.5, 1e-12);
  EXPECT_TRUE(
      test::contains(drawing_of(state, settings).description, "3 needles of lengths 0.5 to 2 "));
  settings.diameters = {0.3};
  state.own_bodies.diameter = {0.5, 0.25, 1};
  const Drawing drawing = drawing_of(state, settings);
  strokes = needles(drawing);
  EXPECT_NEAR(strokes[1].width / strokes[0].width, 0.5, 1e-12);
  EXPECT_NEAR(strokes[2].width / strokes[0].width, 2, 1e-12);
  EXPECT_TRUE(test::contains(drawing.description, ", of diameter 0.25 to 1"));
}

// From above, in lengths: where a stroke begins and ends.
TEST(NeedlePictures, ShowTheTiltOfShearedBoxes) {
  NeedlePicture settings;
  settings.colour = "none";
  settings.camera = {-90, 90, true};  // x to the right, y upwards
  State state = needles_at(8, {{7, 7, 4}, {1, 1, 4}, {15, 4, 4}});
  state.slide = 6;  // tilted by -2
  const Drawing drawing = drawing_of(state, settings);
  ASSERT_EQ(drawing.strokes.size(), 3 + 12);
  std::vector<Point> corners;
  for (const Stroke& stroke : drawing.strokes) {
    if (stroke.halo == 0) corners.insert(corners.end(), {stroke.from, stroke.to});
  }
  ASSERT_EQ(corners.size(), 24);
  const auto below = [](const Point& a, const Point& b) { return a.y > b.y + 1e-6; };
  Point low = corners[0], left = corners[0], right = corners[0];
  for (const Point& corner : corners) {
    if (below(corner, low) || (!below(low, corner) && corner.x < low.x)) low = corner;
    if (corner.x < left.x) left = corner;
    if (corner.x > right.x) right = corner;
  }
  const double scale = (right.x - left.x) / 10;  // from -2 to 8
  const auto place = [&](double x, double y) {
    return Point{low.x + scale * x, low.y - scale * y};
  };
  for (const auto& [x, y] : {std::pair(0, 0), {8, 0}, {-2, 8}, {6, 8}}) {
    const Point wanted = place(x, y);
    EXPECT_EQ(std::count_if(corners.begin(), corners.end(),
                            [&](const Point& corner) {
                              return std::hypot(corner.x - wanted.x, corner.y - wanted.y) < 1e-6;
                            }),
              6)
        << x << ", " << y;
  }
  // Centres are in the box that is drawn.
  std::vector<double> places;
  for (const Stroke& stroke : needles(drawing)) {
    EXPECT_NEAR(length(stroke), scale, 1e-6);
    places.push_back(((stroke.from.x + stroke.to.x) / 2 - low.x) / scale);
  }
  std::sort(places.begin(), places.end());
  ASSERT_EQ(places.size(), 3);
  EXPECT_NEAR(places[0], -1, 1e-6);
  EXPECT_NEAR(places[1], -1, 1e-6);
  EXPECT_NEAR(places[2], 1, 1e-6);
  EXPECT_TRUE(test::contains(drawing.description, "by 8 by 8, tilted by -2"));
}

TEST(NeedlePictures, ShowNeedlesInTheirLength) {
  NeedlePicture settings = along_x();
  settings.lengths = {2};
  // The frame, 832 pixels less two edges of 14, holds the box and half a needle on each side,
  // unless it is the height that limits it: 832 - 14 - 76.
  const double scale = (832 - 14 - 76) / 10.0;
  const std::vector<Stroke> drawn = needles(drawing_of(needles_at(8, {{4, 4, 4}}), settings));
  ASSERT_EQ(drawn.size(), 1);
  EXPECT_NEAR(length(drawn[0]), 2 * scale, 1e-9);
}

TEST(NeedlePictures, ShowEachSpeciesInItsLength) {
  NeedlePicture settings = along_x();
  settings.lengths = {1, 3};
  State state = needles_at(8, {{4, 4, 4}, {4, 4, 5}});
  state.species = {0, 1};
  const Drawing drawing = drawing_of(state, settings);
  const std::vector<Stroke> drawn = needles(drawing);
  ASSERT_EQ(drawn.size(), 2);
  const double first = length(drawn[0]), second = length(drawn[1]);
  EXPECT_NEAR(std::max(first, second) / std::min(first, second), 3, 1e-9);
  EXPECT_TRUE(test::contains(drawing.description, "of lengths 1, 3 in a"));
}

TEST(NeedlePictures, ShowFarNeedlesFirstThinnerAndFainter) {
  NeedlePicture settings;
  settings.colour = "none";
  settings.camera = {90, 0, false};
  const auto drawn = needles(drawing_of(needles_at(8, {{4, 7, 4}, {4, 1, 4}}), settings));
  ASSERT_EQ(drawn.size(), 2);
  EXPECT_LT(drawn[0].width, drawn[1].width);
  EXPECT_LT(length(drawn[0]), length(drawn[1]));
  EXPECT_LT(drawn[0].colour.blue, drawn[1].colour.blue);
}

TEST(NeedlePictures, MoveCentresIntoTheBoxAndDrawNeedlesWhole) {
  const auto inside = needles(drawing_of(needles_at(8, {{0.1, 4, 7.5}}), along_x()));
  const auto outside = needles(drawing_of(needles_at(8, {{8.1, -4, 79.5}}), along_x()));
  ASSERT_EQ(inside.size(), 1);
  ASSERT_EQ(outside.size(), 1);
  EXPECT_NEAR(inside[0].from.x, outside[0].from.x, 1e-6);
  EXPECT_NEAR(inside[0].to.y, outside[0].to.y, 1e-6);
  EXPECT_NEAR(length(inside[0]), (832 - 14 - 76) / 9.0, 1e-6);
}

TEST(NeedlePictures, ColourNeedlesByTheirValue) {
  State state = needles_at(8, {{2, 4, 4}, {6, 4, 4}});
  state.velocity = {{1e-9, 0, 0}, {3, 0, 0}};
  const auto drawn = needles(drawing_of(state, along_x()));
  ASSERT_EQ(drawn.size(), 2);
  const auto share = [](const Stroke& stroke) { return stroke.colour.red - stroke.colour.blue; };
  EXPECT_LT(share(drawn[0]), 0);  // slow is violet
  EXPECT_GT(share(drawn[1]), 0);  // fast is orange to yellow
}

TEST(NeedlePictures, SayWhatTheColoursMeanAndTheTime) {
  State state = needles_at(8, {{2, 4, 4}});
  state.velocity = {{0.5, 0, 0}};
  NeedlePicture settings;
  settings.time = 12.5;
  const Drawing drawing = drawing_of(state, settings);
  std::vector<std::string> words;
  for (const Words& w : drawing.words) words.push_back(w.text);
  EXPECT_EQ(words, (std::vector<std::string>{"speed / 0.5 (rms)", "0", "1", "2", "time 12.5",
                                             "1 needle"}));
  EXPECT_TRUE(test::contains(drawing.description,
                             "at time 12.5; colours are speed / 0.5 (rms) from 0 to 2"));
}

TEST(NeedlePictures, UseOnlyWordsThatTheFontHas) {
  for (const std::string& quantity : quantities()) {
    for (const double speed : {0.0, 1e-12, 0.3, 1e12}) {
      State state = needles_at(8, {{2, 4, 4}, {1, 1, 1}});
      state.velocity = {{speed, 0, 0}, {-speed, 0, 0}};
      NeedlePicture settings;
      settings.colour = quantity;
      settings.time = 1e-7;
      for (const Words& words : drawing_of(state, settings).words) {
        EXPECT_TRUE(can_be_written(words.text)) << words.text;
      }
    }
  }
}

TEST(NeedlePictures, OfSvgAreWellFormedAndHaveALineForEachStroke) {
  const Drawing drawing = drawing_of(needles_at(8, {{2, 4, 4}, {1, 1, 1}}), NeedlePicture{});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg(drawing).c_str()));
  // Those of needles have a second one beneath them.
  EXPECT_EQ(document.select_nodes("//line").size(), drawing.strokes.size() + 2);
  EXPECT_EQ(document.select_nodes("//text").size(), drawing.words.size());
}

TEST(Drawings, OfSvgEscapeTextsAndWhatXmlCannotHold) {
  Drawing drawing;
  drawing.title = "a <b> & \"c\"";
  drawing.words = {{"tab\there, bell\a", {0, 0}, Words::Anchor::end, 13, {}}};
  pugi::xml_document document;
  const std::string text = svg(drawing);
  ASSERT_TRUE(document.load_string(text.c_str()));
  EXPECT_STREQ(document.select_node("//title").node().text().get(), "a <b> & \"c\"");
  EXPECT_FALSE(test::contains(text, "\a"));
  EXPECT_STREQ(document.select_node("//text/@text-anchor").attribute().value(), "end");
}

TEST(NeedlePictures, FitIntoAnySize) {
  for (const auto& [width, height] : {std::pair{300, 300}, {300, 2000}, {2000, 300}}) {
    NeedlePicture settings;
    settings.width = width;
    settings.height = height;
    settings.time = 123456;
    const Drawing drawing =
        drawing_of(needles_at(8, {{0, 0, 0}, {0, 8, 0}, {8, 0, 8}, {8, 8, 8}}), settings);
    for (const Stroke& stroke : drawing.strokes) {
      for (const Point& p : {stroke.from, stroke.to}) {
        EXPECT_GE(p.x, 0);
        EXPECT_LE(p.x, width);
        EXPECT_GE(p.y, 0);
        EXPECT_LE(p.y, height);
      }
    }
    for (const Words& words : drawing.words) EXPECT_LT(length_of(words), width);
  }
}

}  // namespace
}  // namespace needlework::picture
