// Charts of curves, maps of colours and arrows, drawn as SVG.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "src/picture/ticks.h"

namespace needlework::picture {

/// Titles, labels and names are plain text, in which _{...} is set below the line and ^{...} above
/// it, as in "T_{tr} / T_{rot}".
struct Axis {
  std::string label = {};
  bool logarithmic = false;
  std::optional<Range> range = {};  ///< what the panel shows; by default all data and a margin
};

/// The colours of the values of a map and of curves with `values`.
struct ColourScale {
  std::string label = {};  ///< beside the bar that explains the colours
  bool logarithmic = false;
  bool diverging = false;  ///< two hues that meet in the middle of the range, by default at 0
  std::optional<Range> range =
      {};  ///< values beyond it get the colour of its end; default: all values
};

/// A family of values of y at values of x, of the same number. What cannot be placed (NaN,
/// infinite, or not positive on a logarithmic axis) is left out: a line has a gap there.
struct Curve {
  enum class Style {
    line,
    dashed,
    points,
    steps,  ///< a histogram: y is constant between edges, and x has one number more than y
  };
  std::string name = {};  ///< in the legend; not there if empty
  Style style = Style::line;
  std::vector<double> x = {}, y = {};
  std::vector<double> error = {};  ///< half the length of the error bar of each y; may be empty
  /// Colour, and shape of points, counted from 0; by default the place of the curve in the panel.
  /// Curves that belong together, such as theory and measurement, should have the same.
  std::optional<std::size_t> colour = {};
  /// For points: each is filled with the colour of its value in the scale of the panel. May be
  /// empty.
  std::vector<double> values = {};
};

/// Values on a grid of rectangles, shown as colours. A value that is not finite leaves a gap.
struct Map {
  std::vector<double> x_edges, y_edges;  ///< one more than there are columns and rows
  std::vector<double> values;            ///< row after row, from the first y
  bool contours = false;                 ///< draws lines at the labelled values of the bar
};

/// A field of vectors (u, v) on a grid of points (x, y). The longest arrow is as long as a cell.
struct Arrows {
  std::string name;  ///< of their length, in the legend; not there if empty
  std::vector<double> x, y, u, v;
  double cell = 1;  ///< distance of points [units of the x axis]
};

struct Panel {
  std::string title = {};
  Axis x = {}, y = {};
  std::vector<Curve> curves = {};
  std::optional<Map> map = {};
  std::optional<Arrows> arrows = {};
  ColourScale colours = {};
  bool equal_scales = false;  ///< a unit of x is as long as a unit of y, on linear axes
};

struct Chart {
  std::string title;
  std::string description = {};  ///< for those who cannot see the chart; default: what the axes say
  std::vector<Panel> panels = {};
  std::size_t columns = 0;                       ///< panels in a row; 0: all in one
  double panel_width = 380, panel_height = 285;  ///< of the area inside the axes [pixels]
};

/// The chart as the text of an SVG file, which is XML 1.0 in UTF-8. It has a light ground of its
/// own and colours that are distinct for the colour-blind too. Throws std::invalid_argument, which
/// names the panel, if vectors that belong together have different sizes.
std::string svg(const Chart& chart);

}  // namespace needlework::picture
