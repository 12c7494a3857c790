#include "src/picture/terminal_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/contains.h"

namespace needlework::picture {
namespace {

const double no_value = std::numeric_limits<double>::quiet_NaN();

std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

Panel diagonal() {
  Panel panel;
  panel.title = "Ttr";
  panel.x = {"time", false, Range{0, 10}};
  panel.y = {"", false, Range{0, 1}};
  panel.curves.resize(2);
  panel.curves[0].x = {0, 10};
  panel.curves[0].y = {0, 1};
  panel.curves[0].name = "theory";
  panel.curves[1].style = Curve::Style::points;
  panel.curves[1].x = {10, no_value, 3, 5};
  panel.curves[1].y = {0, 0.5, 2, no_value};
  panel.curves[1].name = "run";
  return panel;
}

TEST(TerminalChart, DrawsLinesAsDotsAndPointsAsLetters) {
  EXPECT_EQ(joined(terminal_lines(diagonal(), {30, 8}, false)),
            "Ttr  ⠒⠒ theory  o run         \n"
            "1.0┤                     ⣀⡠⠔⠒⠉\n"
            "   │               ⢀⣀⠤⠔⠊⠉     \n"
            "0.5┤          ⢀⡠⠤⠒⠊⠁          \n"
            "   │     ⣀⡠⠔⠒⠉⠁               \n"
            "  0┤⣀⠤⠔⠊⠉                    o\n"
            "   └┴────────────┴───────────┴\n"
            "    0            5          10\n");
}

TEST(TerminalChart, NamesItsXAxisWhereThereIsRoom) {
  Panel panel = diagonal();
  EXPECT_TRUE(terminal_lines(panel, {30, 8}, false).back().ends_with("10"));
  panel.x.range = Range{0, 9};
  EXPECT_TRUE(terminal_lines(panel, {30, 8}, false).back().ends_with(" time"))
      << terminal_lines(panel, {30, 8}, false).back();
}

TEST(TerminalChart, FillsItsSizeWhateverTheCurves) {
  for (const bool logarithmic : {false, true}) {
    for (const std::vector<double>& y : {std::vector<double>{},
                                         {1},
                                         {no_value},
                                         {0, 0},
                                         {1e-300, 1e300},
                                         {-5, 3, no_value, 8},
                                         {1, 1, 1}}) {
      Panel panel;
      panel.title = "a title that is longer than the narrowest chart";
      panel.x = {"time", logarithmic, {}};
      panel.y.logarithmic = logarithmic;
      for (const auto style : {Curve::Style::line, Curve::Style::points}) {
        Curve& curve = panel.curves.emplace_back();
        curve.style = style;
        curve.y = y;
        for (std::size_t i = 0; i < y.size(); ++i) curve.x.push_back(static_cast<double>(i + 1));
      }
      for (const TerminalSize size : {smallest_terminal_chart, TerminalSize{40, 12}, {200, 60}}) {
        const auto lines = terminal_lines(panel, size, false);
        EXPECT_EQ(lines.size(), size.rows);
        for (const std::string& line : lines) EXPECT_EQ(columns(line), size.columns) << line;
      }
    }
  }
}

TEST(TerminalChart, LeavesAGapWhereAValueHasNoPlace) {
  Panel panel = diagonal();
  panel.curves.resize(1);
  panel.curves[0].x = {0, 2, 5, 8, 10};
  panel.curves[0].y = {0.5, 0.5, no_value, 0.5, 0.5};
  const std::string line = terminal_lines(panel, {30, 8}, false)[3];
  EXPECT_TRUE(test::contains(line, {"⠤⠤⠤⠤⠤", "              "}));
}

TEST(TerminalChart, WritesPowersOfTenWithRaisedDigits) {
  Panel panel = diagonal();
  panel.y = {"", true, Range{1e-12, 1}};
  const std::string text = joined(terminal_lines(panel, {40, 12}, false));
  EXPECT_TRUE(test::contains(text, {"10⁻⁸┤", "   1┤"}));
}

TEST(TerminalChart, ColoursOnlyIfAskedFor) {
  EXPECT_FALSE(test::contains(joined(terminal_lines(diagonal(), {30, 8}, false)), "\033"));
  std::string text = joined(terminal_lines(diagonal(), {30, 8}, true));
  EXPECT_TRUE(test::contains(text, {"\033[36m⠒⠒\033[0m theory", "\033[33mo\033[0m"}));
  // What is drawn is the same.
  for (auto at = text.find('\033'); at != text.npos; at = text.find('\033')) {
    text.erase(at, text.find('m', at) + 1 - at);
  }
  EXPECT_EQ(text, joined(terminal_lines(diagonal(), {30, 8}, false)));
}

}  // namespace
}  // namespace needlework::picture
