#include "src/picture/stroke_font.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace needlework::picture {
namespace {

std::vector<Stroke> written(const std::string& text, Words::Anchor anchor = Words::Anchor::start) {
  return strokes_of({text, {100, 50}, anchor, 20, {}});
}

TEST(StrokeFont, HasADifferentShapeForEachCharacter) {
  const std::string characters = "abcdefghijklmnopqrstuvwxyz0123456789.,:/-+=()";
  EXPECT_TRUE(can_be_written(characters));
  std::set<std::string> shapes;
  for (const char c : characters) {
    std::string shape;
    for (const Stroke& s : written(std::string(1, c))) {
      shape += std::to_string(s.from.x) + " " + std::to_string(s.from.y) + " " +
               std::to_string(s.to.x) + " " + std::to_string(s.to.y) + ";";
    }
    EXPECT_TRUE(shapes.insert(shape).second) << c;
  }
}

TEST(StrokeFont, KeepsToItsLineAndItsLength) {
  for (const char c : std::string("abcdefghijklmnopqrstuvwxyz0123456789.,:/-+=()A")) {
    const Words words{std::string(1, c), {100, 50}, Words::Anchor::start, 20, {}};
    for (const Stroke& stroke : strokes_of(words)) {
      for (const Point& p : {stroke.from, stroke.to}) {
        EXPECT_GE(p.x, 100 - 0.1) << c;
        EXPECT_LE(p.x, 100 + length_of(words) + 0.1) << c;
        EXPECT_GE(p.y, 50 - 6.9 * 2.4) << c;
        EXPECT_LE(p.y, 50 + 2.1 * 2.4) << c;
      }
    }
  }
}

TEST(StrokeFont, IsPlacedByItsAnchor) {
  const auto bounds = [](const std::vector<Stroke>& strokes) {
    std::pair bounds{1e9, -1e9};
    for (const Stroke& s : strokes) {
      bounds.first = std::min({bounds.first, s.from.x, s.to.x});
      bounds.second = std::max({bounds.second, s.from.x, s.to.x});
    }
    return bounds;
  };
  EXPECT_NEAR(bounds(written("ll mom ll")).first, 100, 0.1);
  EXPECT_NEAR(bounds(written("ll mom ll", Words::Anchor::end)).second, 100, 0.1);
  const auto middle = bounds(written("ll mom ll", Words::Anchor::middle));
  EXPECT_NEAR((middle.first + middle.second) / 2, 100, 0.1);
  EXPECT_TRUE(written("  ").empty());
}

TEST(StrokeFont, ShowsWhatItDoesNotKnowAsABox) {
  EXPECT_FALSE(can_be_written("A"));
  EXPECT_EQ(written("A").size(), 4);
}

}  // namespace
}  // namespace needlework::picture
