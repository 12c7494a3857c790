// Curves drawn with the characters of a terminal.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "src/picture/ticks.h"

namespace needlework::picture {

struct TerminalSize {
  std::size_t columns = 80, rows = 24;
};

struct Axis {
  std::string label = {};
  bool logarithmic = false;
  std::optional<Range> range = {};  ///< what the panel shows; by default all data
};

/// Values of y at values of x, of the same number. What cannot be placed (NaN, infinite, or not
/// positive on a logarithmic axis) is left out: a line has a gap there.
struct Curve {
  enum class Style { line, points };
  std::string name = {};  ///< in the legend; not there if empty
  Style style = Style::line;
  std::vector<double> x = {}, y = {};
  /// Counted from 0; by default the place of the curve in the panel.
  std::optional<std::size_t> colour = {};
};

struct Panel {
  std::string title = {};
  Axis x = {}, y = {};
  std::vector<Curve> curves = {};
};

/// The title, axes and curves of a panel as lines of text in UTF-8, as many and as long as the size
/// says, which must be at least smallest_terminal_chart. Lines are of braille dots, eight to a
/// character, points are `o`, so that they are distinct without colours too. `colours` adds escape
/// sequences that colour them.
std::vector<std::string> terminal_lines(const Panel& panel, TerminalSize size, bool colours);

constexpr TerminalSize smallest_terminal_chart{24, 6};

}  // namespace needlework::picture
