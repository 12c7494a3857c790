// Lines of equal value of a map.
#pragma once

#include <utility>
#include <vector>

#include "src/picture/chart.h"
#include "src/picture/marks.h"

namespace needlework::picture {

/// The lines on which the map has this value, as segments in pixels, by marching squares between
/// the middles of the rectangles. Squares with a corner that is not finite have none.
std::vector<std::pair<Point, Point>> contour(const Map& map, double level, const Area& area);

}  // namespace needlework::picture
