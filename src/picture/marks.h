// The marks inside the axes of a panel: curves, maps and arrows.
#pragma once

#include <pugixml.hpp>
#include <vector>

#include "src/picture/chart.h"
#include "src/picture/colours.h"
#include "src/picture/point.h"

namespace needlework::picture {

/// The scales of a panel: pixels of x from left to right, of y from the bottom up.
struct Area {
  Scale x, y;

  Point operator()(double x_value, double y_value) const { return {x(x_value), y(y_value)}; }
  /// Whether a point that could be placed is inside the axes.
  bool holds(const Point& point) const;
};

/// A ColourScale with the range of its values.
struct ColouredRange {
  Scale share;  ///< of the gradient, from 0 to 1
  Gradient gradient;

  Colour operator()(double value) const { return colour_at(gradient, share(value)); }
};

/// The parts of a curve of lines that are inside the axes, apart where there are gaps. Of points
/// that fall on each other in the picture one is kept.
std::vector<std::vector<Point>> lines_of(const Curve& curve, const Area& area);

void draw_curve(pugi::xml_node parent, const Curve& curve, std::size_t colour, const Area& area,
                const ColouredRange& colours);
void draw_map(pugi::xml_node parent, const Map& map, const Area& area,
              const ColouredRange& colours);
/// Lines at the levels that have a label.
void draw_contours(pugi::xml_node parent, const Map& map, const std::vector<Tick>& levels,
                   const Area& area, const ColouredRange& colours);
void draw_arrows(pugi::xml_node parent, const Arrows& arrows, const Area& area);

/// A sample of the marks of a curve from (x, y) on, for the legend, and its width.
constexpr double sample_width = 26;
void draw_sample(pugi::xml_node parent, const Curve& curve, std::size_t colour, Point place);
void draw_arrow_sample(pugi::xml_node parent, Point place);

/// The longest of the arrows that can be placed; 0 if there are none.
double longest_arrow(const Arrows& arrows);

}  // namespace needlework::picture
