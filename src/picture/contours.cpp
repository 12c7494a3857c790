#include "src/picture/contours.h"

#include <array>
#include <cmath>

namespace needlework::picture {
namespace {

std::vector<double> middles(const std::vector<double>& edges, const Scale& scale) {
  std::vector<double> all;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    all.push_back((scale(edges[i - 1]) + scale(edges[i])) / 2);
  }
  return all;
}

struct Corner {
  Point place;
  double height;  // above the level
};

// Where the sides of a square cross the level, in the order of the sides.
std::vector<Point> crossings(const std::array<Corner, 4>& corners) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& [a, a_height] = corners[i];
    const auto& [b, b_height] = corners[(i + 1) % 4];
    if ((a_height > 0) == (b_height > 0)) continue;
    const double share = a_height / (a_height - b_height);
    points.push_back({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)});
  }
  return points;
}

}  // namespace

std::vector<std::pair<Point, Point>> contour(const Map& map, double level, const Area& area) {
  const std::vector<double> x = middles(map.x_edges, area.x), y = middles(map.y_edges, area.y);
  const auto corner = [&](std::size_t i, std::size_t j) {
    return Corner{{x[i], y[j]}, map.values[j * x.size() + i] - level};
  };
  std::vector<std::pair<Point, Point>> segments;
  for (std::size_t j = 1; j < y.size(); ++j) {
    for (std::size_t i = 1; i < x.size(); ++i) {
      const std::array corners{corner(i - 1, j - 1), corner(i, j - 1), corner(i, j),
                               corner(i - 1, j)};
      double sum = 0, places = 0;
      for (const Corner& c : corners) sum += c.height, places += c.place.x + c.place.y;
      if (!std::isfinite(sum) || !std::isfinite(places)) continue;
      const std::vector<Point> points = crossings(corners);
      if (points.size() == 2) segments.emplace_back(points[0], points[1]);
      if (points.size() < 4) continue;
      // A saddle: the value in its middle decides which corners are joined.
      const std::size_t first = (sum > 0) == (corners[0].height > 0) ? 0 : 1;
      segments.emplace_back(points[first], points[first + 1]);
      segments.emplace_back(points[first + 2], points[(first + 3) % 4]);
    }
  }
  return segments;
}

}  // namespace needlework::picture
