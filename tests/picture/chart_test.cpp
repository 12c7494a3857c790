#include "src/picture/chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <pugixml.hpp>
#include <stdexcept>
#include <string>

namespace needlework::picture {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double nan = std::numeric_limits<double>::quiet_NaN();

pugi::xml_document parsed(const Chart& chart) {
  const std::string text = svg(chart);
  pugi::xml_document document;
  const auto result = document.load_string(text.c_str());
  EXPECT_TRUE(result) << result.description();
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
  return document;
}

pugi::xml_document parsed(const Panel& panel) {
  Chart chart;
  chart.title = "test";
  chart.panels = {panel};
  return parsed(chart);
}

Panel with(Curve curve, bool logarithmic = false) {
  Panel panel;
  panel.y.logarithmic = logarithmic;
  curve.colour = 0;
  panel.curves = {std::move(curve)};
  return panel;
}

// Lines of the first colour.
std::string line_of(const pugi::xml_document& document) {
  return document.select_node("//path[@stroke='#0072b2'][@stroke-width='1.8']")
      .node()
      .attribute("d")
      .value();
}

std::size_t points_of(const pugi::xml_document& document) {
  return document.select_nodes("//g[@fill='#0072b2']/path").size();
}

std::ptrdiff_t count(const std::string& text, char c) {
  return std::count(text.begin(), text.end(), c);
}

Curve curve(Curve::Style style, std::vector<double> x, std::vector<double> y) {
  Curve curve;
  curve.style = style;
  curve.x = std::move(x);
  curve.y = std::move(y);
  return curve;
}

TEST(Chart, WithoutAnythingIsAPicture) {
  EXPECT_STREQ(parsed(Chart{}).document_element().name(), "svg");
  const pugi::xml_document empty = parsed(Panel{});
  EXPECT_STREQ(empty.document_element().name(), "svg");
  EXPECT_GT(empty.select_nodes("//text").size(), 4);  // ticks
}

TEST(Chart, OfEmptyDataIsAPicture) {
  for (const auto style : {Curve::Style::line, Curve::Style::points, Curve::Style::steps}) {
    Panel panel = with(curve(style, {}, {}));
    panel.map.emplace();
    panel.arrows.emplace();
    EXPECT_TRUE(line_of(parsed(panel)).empty());
  }
}

TEST(Chart, SaysWhatItShowsToThoseWhoCannotSeeIt) {
  Chart chart;
  chart.title = "Cooling of T_{tr}";
  chart.panels = {with(curve(Curve::Style::line, {0, 1}, {1, 2}))};
  chart.panels[0].x.label = "time";
  chart.panels[0].y = {"energy", true, {}};
  chart.panels[0].curves[0].name = "theory";
  const pugi::xml_document automatic = parsed(chart);
  const pugi::xml_node root = automatic.document_element();
  EXPECT_STREQ(root.child("title").child_value(), "Cooling of Ttr");
  EXPECT_STREQ(root.child("desc").child_value(), "energy (logarithmic) against time; theory.");
  chart.description = "What it is.";
  EXPECT_STREQ(parsed(chart).document_element().child("desc").child_value(), "What it is.");
}

TEST(Chart, EscapesTextsAndWhatXmlCannotHold) {
  Chart chart;
  chart.title = "a < b & \"c\" \x01 \xff";
  const pugi::xml_document document = parsed(chart);
  EXPECT_STREQ(document.document_element().child("title").child_value(),
               "a < b & \"c\" \\x01 \\xff");
  EXPECT_NE(svg(chart).find("a &lt; b &amp;"), std::string::npos);
}

TEST(Chart, SetsPartsOfTextsBelowAndAboveTheLine) {
  Panel panel;
  panel.title = "T_{tr} ~ t^{−2} _ {}";
  const pugi::xml_document document = parsed(panel);
  const auto parts = document.select_nodes("//text[@font-weight='bold'][tspan]/tspan");
  ASSERT_EQ(parts.size(), 4);
  EXPECT_STREQ(parts[0].node().child_value(), "tr");
  EXPECT_STREQ(parts[2].node().child_value(), "−2");
  double height = 0;
  for (const auto& part : parts) height += part.node().attribute("dy").as_double();
  EXPECT_NEAR(height, 0, 1e-9);
  EXPECT_STREQ(parts[3].node().child_value(), " _ {}");
}

TEST(Chart, DrawsEachPointOnce) {
  EXPECT_EQ(points_of(parsed(with(curve(Curve::Style::points, {1, 2, 3, 3}, {1, 5, 2, 2})))), 4);
}

TEST(Chart, LeavesOutPointsThatHaveNoPlace) {
  const Curve points =
      curve(Curve::Style::points, {1, nan, 3, 4, 5, infinity}, {1, 2, nan, infinity, -1, 3});
  EXPECT_EQ(points_of(parsed(with(points))), 2);
  EXPECT_EQ(points_of(parsed(with(points, true))), 1);  // -1 has no logarithm
}

TEST(Chart, LeavesOutPointsBeyondTheRange) {
  Panel panel = with(curve(Curve::Style::points, {1, 2, 3, 4}, {1, 2, 3, 4}));
  panel.x.range = {1.5, 3.5};
  EXPECT_EQ(points_of(parsed(panel)), 2);
}

TEST(Chart, HasAGapInALineWhereAValueHasNoPlace) {
  const std::vector<double> x{0, 1, 2, 3, 4, 5, 6};
  EXPECT_EQ(count(line_of(parsed(with(curve(Curve::Style::line, x, {1, 2, 3, 4, 3, 2, 1})))), 'M'),
            1);
  EXPECT_EQ(
      count(line_of(parsed(with(curve(Curve::Style::line, x, {1, 2, 3, nan, 3, 2, 1})))), 'M'), 2);
  EXPECT_EQ(
      count(
          line_of(parsed(with(curve(Curve::Style::line, x, {1, 2, 0, 4, -infinity, 2, 1}), true))),
          'M'),
      2);
  EXPECT_EQ(
      count(line_of(parsed(with(curve(Curve::Style::steps, {0, 1, 2, 3, 4}, {1, 2, nan, 3})))),
            'M'),
      2);
}

TEST(Chart, CutsLinesAtTheAxes) {
  Panel panel = with(curve(Curve::Style::line, {0, 10}, {0, 10}));
  panel.x.range = {2, 4};
  panel.y.range = {0, 10};
  // A fifth of the height at x = 2, two fifths at x = 4, of 380 by 285 pixels.
  EXPECT_EQ(line_of(parsed(panel)), "M0 228L380 171");
}

TEST(Chart, KeepsOneOfManyPointsOfALineThatFallOnEachOther) {
  std::vector<double> x, y;
  for (int i = 0; i <= 100000; ++i) {
    x.push_back(i);
    y.push_back(i % 2);
  }
  Panel panel = with(curve(Curve::Style::line, x, std::vector<double>(x.size(), 0.5)));
  EXPECT_LT(line_of(parsed(panel)).size(), 80000);
}

TEST(Chart, DrawsAStepBetweenTwoEdges) {
  Panel panel = with(curve(Curve::Style::steps, {0, 1, 2}, {0, 10}));
  panel.x.range = {0, 2};
  panel.y.range = {0, 10};
  EXPECT_EQ(line_of(parsed(panel)), "M0 285L190 285 190 0 380 0");
}

TEST(Chart, DrawsErrorBarsDownToTheAxisWhereTheyReachZero) {
  Curve points = curve(Curve::Style::points, {1, 2, 3}, {10, 10, 10});
  points.error = {9, 20, nan};
  Panel panel = with(points, true);
  panel.x.range = {0, 4};
  panel.y.range = {1e-1, 1e2};
  const pugi::xml_document document = parsed(panel);
  const std::string bars =
      document.select_node("//path[@stroke-width='1.2']").node().attribute("d").value();
  ASSERT_EQ(count(bars, 'M'), 2);
  EXPECT_EQ(bars.substr(0, bars.find('L')), "M95 190");          // from 1 to 19
  EXPECT_NE(bars.find("M190 285L190 49.7"), std::string::npos);  // from the axis to 30
}

TEST(Chart, ShowsTheRangeOfErrorBars) {
  Curve points = curve(Curve::Style::points, {0, 1}, {0, 0});
  points.error = {100, 100};
  const std::string text = svg(Chart{.title = "", .description = "", .panels = {with(points)}});
  EXPECT_NE(text.find(">100<"), std::string::npos);
}

TEST(Chart, ShowsEachFiniteValueOfAMapAsARectangle) {
  Panel panel;
  panel.map = Map{{0, 1, 2, 3}, {0, 1, 2}, {1, 2, 3, nan, 2, infinity}};
  const pugi::xml_document document = parsed(panel);
  std::string all;
  for (const auto& path : document.select_nodes("//g[@shape-rendering]/path")) {
    all += path.node().attribute("d").value();
  }
  EXPECT_EQ(count(all, 'z'), 4);
  // The least value has the first colour, and stands below on the left.
  const auto first = document.select_node("//path[@fill='#440154']").node();
  EXPECT_STREQ(first.attribute("d").value(), "M0 285H126.7V142.5H0z");
  EXPECT_TRUE(document.select_node("//text[text()='1.5']"));  // a tick of the bar
}

TEST(Chart, DefinesNothingByNameSoThatSeveralFitIntoOnePage) {
  Panel panel;
  panel.map = Map{{0, 1}, {0, 1}, {1}};
  EXPECT_FALSE(parsed(panel).select_node("//*[@id]"));
}

TEST(Chart, DrawsContoursWhereTheMapHasTheValueOfATick) {
  Panel panel;
  panel.map = Map{{0, 1, 2, 3, 4}, {0, 1, 2}, {0, 1, 2, 3, 0, 1, 2, 3}, true};
  panel.colours.range = {0.5, 1.9};
  panel.x.range = {0, 4};
  const auto contours = [](const pugi::xml_document& document) {
    std::string all;
    for (const auto& path : document.select_nodes("//g[@stroke-opacity]/path")) {
      all += path.node().attribute("d").value();
    }
    return all;
  };
  // Values grow by 1 from middle to middle: 1 is at x = 1.5.
  EXPECT_NE(contours(parsed(panel)).find("M142.5 213.8L142.5 71.2"), std::string::npos)
      << contours(parsed(panel));
  panel.map->values[1] = nan;
  EXPECT_EQ(contours(parsed(panel)).find("M142.5 "), std::string::npos);
}

TEST(Chart, DrawsArrowsOfWhichTheLongestIsAsLongAsACell) {
  Panel panel;
  panel.arrows =
      Arrows{"speed", {0.5, 1.5, 2.5, 3.5}, {0.5, 0.5, 0.5, 0.5}, {2, 1, 0, nan}, {0, 0, 0, 1}};
  const pugi::xml_document document = parsed(panel);
  const std::string arrows =
      document.select_node("//path[@stroke-linecap='round']").node().attribute("d").value();
  EXPECT_EQ(count(arrows, 'M'), 4);  // two arrows, each a line and a head
  EXPECT_EQ(arrows.find("M0 142.5L95 142.5"), 0);
  EXPECT_NE(arrows.find("M118.8 142.5L166.2 142.5"), std::string::npos);
  EXPECT_TRUE(document.select_node("//text[text()='speed: 2']"));
}

TEST(Chart, FillsPointsWithTheColoursOfTheirValues) {
  Curve points = curve(Curve::Style::points, {1, 2, 3}, {1, 2, 3});
  points.values = {0, 1, nan};
  const pugi::xml_document document = parsed(with(points));
  EXPECT_EQ(document.select_nodes("//path[@fill='#440154']").size(), 1);
  EXPECT_EQ(document.select_nodes("//path[@fill='#fde725']").size(), 1);
  EXPECT_EQ(document.select_nodes("//g[@stroke='#ffffff']/path").size(), 2);
}

TEST(Chart, HasEqualScalesIfAskedFor) {
  Panel panel;
  panel.map = Map{{0, 1, 2}, {0, 1, 2, 3, 4}, std::vector<double>(8, 1.0)};
  panel.equal_scales = true;
  const pugi::xml_document document = parsed(panel);
  EXPECT_TRUE(document.select_node("//rect[@width='380'][@height='760']"));
}

TEST(Chart, PutsLegendsWhereTheyHideNothing) {
  // A curve in all corners leaves no room inside.
  Panel panel = with(curve(Curve::Style::line, {0, 1, 1, 0, 0}, {0, 0, 1, 1, 0}));
  panel.curves[0].name = "square";
  EXPECT_FALSE(parsed(panel).select_node("//rect[@rx]"));
  panel.curves[0] = curve(Curve::Style::line, {0, 1}, {0, 1});
  panel.curves[0].name = "diagonal";
  EXPECT_TRUE(parsed(panel).select_node("//rect[@rx]"));
}

TEST(Chart, PutsPanelsInRows) {
  Chart chart;
  chart.columns = 2;
  chart.panels.resize(3);
  const auto places = parsed(chart).select_nodes("//g[@transform]");
  ASSERT_EQ(places.size(), 3);
  const auto place = [&](std::size_t i) {
    return std::string(places[i].node().attribute("transform").value());
  };
  const auto x = [&](std::size_t i) { return place(i).substr(0, place(i).find(' ')); };
  const auto y = [&](std::size_t i) { return place(i).substr(place(i).find(' ')); };
  EXPECT_EQ(x(0), x(2));
  EXPECT_NE(x(0), x(1));
  EXPECT_EQ(y(0), y(1));
  EXPECT_NE(y(0), y(2));
}

TEST(Chart, RejectsVectorsOfDifferentSizes) {
  const auto message = [](const Panel& panel) -> std::string {
    try {
      parsed(panel);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  Panel panel = with(curve(Curve::Style::line, {1, 2}, {1}));
  panel.title = "first";
  EXPECT_EQ(message(panel), "panel 0 'first', curve 0 '': x: 2 values: expected 1");
  panel = with(curve(Curve::Style::steps, {1, 2}, {1, 2}));
  EXPECT_EQ(message(panel), "panel 0 '', curve 0 '': x: 2 values: expected 3");
  panel = with(curve(Curve::Style::points, {1, 2}, {1, 2}));
  panel.curves[0].error = {1};
  EXPECT_EQ(message(panel), "panel 0 '', curve 0 '': error: 1 values: expected 2");
  panel = {};
  panel.map = Map{{0, 1, 2}, {0, 1}, {1}};
  EXPECT_EQ(message(panel), "panel 0 '': map: 1 values: expected 2");
  panel = {};
  panel.arrows = Arrows{"", {1}, {1}, {1}, {}};
  EXPECT_EQ(message(panel), "panel 0 '': v of arrows: 0 values: expected 1");
}

}  // namespace
}  // namespace needlework::picture
