#include "src/picture/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "src/picture/contours.h"
#include "src/picture/svg_document.h"

namespace needlework::picture {
namespace {

constexpr double line_width = 1.8;

bool is_finite(const Point& point) { return std::isfinite(point.x) && std::isfinite(point.y); }

// The part of a segment inside the axes, by the method of Liang and Barsky.
std::optional<std::pair<Point, Point>> clipped(Point a, Point b, const Area& area) {
  const Point d{b.x - a.x, b.y - a.y};
  double begin = 0, end = 1;
  for (const auto& [along, from, low, high] : {std::array{d.x, a.x, area.x.begin, area.x.end},
                                               std::array{d.y, a.y, area.y.end, area.y.begin}}) {
    if (along == 0) {
      if (from < low || from > high) return std::nullopt;
      continue;
    }
    const auto [enter, leave] = std::minmax({(low - from) / along, (high - from) / along});
    begin = std::max(begin, enter);
    end = std::min(end, leave);
  }
  if (begin > end) return std::nullopt;
  return std::pair(Point{a.x + begin * d.x, a.y + begin * d.y},
                   Point{a.x + end * d.x, a.y + end * d.y});
}

// The corners of a curve in pixels; those that cannot be placed are not finite.
std::vector<Point> corners_of(const Curve& curve, const Area& area) {
  std::vector<Point> corners;
  for (std::size_t i = 0; i < curve.y.size(); ++i) {
    corners.push_back(area(curve.x[i], curve.y[i]));
    if (curve.style == Curve::Style::steps) corners.push_back(area(curve.x[i + 1], curve.y[i]));
  }
  return corners;
}

bool look_equal(const Point& a, const Point& b) {
  return std::abs(a.x - b.x) < 0.1 && std::abs(a.y - b.y) < 0.1;
}

std::string path_of(const std::vector<Point>& line) {
  std::string path = fmt::format("M{} {}", pixels(line[0].x), pixels(line[0].y));
  for (std::size_t i = 1; i < line.size(); ++i) {
    path += fmt::format("{}{} {}", i == 1 ? "L" : " ", pixels(line[i].x), pixels(line[i].y));
  }
  return path;
}

std::string circle(Point at, double radius) {
  const std::string r = pixels(radius), d = pixels(2 * radius);
  return fmt::format("M{} {}m-{} 0a{} {} 0 1 0 {} 0a{} {} 0 1 0 -{} 0z", pixels(at.x), pixels(at.y),
                     r, r, r, d, r, r, d);
}

// Shapes of points: circle, square, triangle, diamond.
std::string marker(std::size_t shape, Point at) {
  const std::string x = pixels(at.x), y = pixels(at.y);
  switch (shape % 4) {
    case 0:
      return circle(at, 3);
    case 1:
      return fmt::format("M{} {}m-2.7 -2.7h5.4v5.4h-5.4z", x, y);
    case 2:
      return fmt::format("M{} {}m0 -3.6l3.5 6.2h-7z", x, y);
    default:
      return fmt::format("M{} {}m0 -3.9l3.9 3.9l-3.9 3.9l-3.9 -3.9z", x, y);
  }
}

void draw_line(pugi::xml_node parent, const std::string& path, const Curve& curve, Colour colour) {
  pugi::xml_node node = add(parent, "path",
                            {{"d", path},
                             {"fill", "none"},
                             {"stroke", colour},
                             {"stroke-width", line_width},
                             {"stroke-linejoin", "round"}});
  if (curve.style == Curve::Style::dashed) set(node, {"stroke-dasharray", "6 4"});
}

void draw_points(pugi::xml_node parent, const Curve& curve, std::size_t number, const Area& area,
                 const ColouredRange& colours) {
  const bool by_value = !curve.values.empty();
  pugi::xml_node group =
      by_value
          ? add(parent, "g", {{"stroke", "#ffffff"}, {"stroke-width", 1.4}})
          : add(parent, "g",
                {{"fill", curve_colour(number)}, {"stroke", "#ffffff"}, {"stroke-width", 0.6}});
  for (std::size_t i = 0; i < curve.y.size(); ++i) {
    const Point at = area(curve.x[i], curve.y[i]);
    if (!is_finite(at) || !area.holds(at)) continue;
    if (by_value && std::isnan(colours.share(curve.values[i]))) continue;
    if (by_value) {
      add(group, "path", {{"d", circle(at, 5)}, {"fill", colours(curve.values[i])}});
    } else {
      add(group, "path", {{"d", marker(number, at)}});
    }
  }
}

void draw_error_bars(pugi::xml_node parent, const Curve& curve, Colour colour, const Area& area) {
  std::string path;
  for (std::size_t i = 0; i < curve.error.size(); ++i) {
    const Point middle = area(curve.x[i], curve.y[i]);
    if (!is_finite(middle) || !std::isfinite(curve.error[i])) continue;
    double low = area.y(curve.y[i] - curve.error[i]);
    const double high = area.y(curve.y[i] + curve.error[i]);
    if (std::isnan(low)) low = area.y.begin;  // reaches zero, which is below a logarithmic axis
    const auto bar = clipped({middle.x, low}, {middle.x, high}, area);
    if (!bar || !std::isfinite(high)) continue;
    path += path_of({bar->first, bar->second});
  }
  if (path.empty()) return;
  add(parent, "path", {{"d", path}, {"fill", "none"}, {"stroke", colour}, {"stroke-width", 1.2}});
}

// From the tail to the tip and to both ends of its head.
std::string arrow_path(Point tail, Point tip) {
  const Point d{tip.x - tail.x, tip.y - tail.y};
  const double length = std::hypot(d.x, d.y);
  const double head = std::min(0.35 * length, 7.0) / length;
  const auto barb = [&](double side) {
    return Point{tip.x - head * (d.x + side * 0.5 * d.y), tip.y - head * (d.y - side * 0.5 * d.x)};
  };
  return path_of({tail, tip}) + path_of({barb(1), tip, barb(-1)});
}

void draw_arrow_paths(pugi::xml_node parent, const std::string& path) {
  if (path.empty()) return;
  add(parent, "path",
      {{"d", path},
       {"fill", "none"},
       {"stroke", ink},
       {"stroke-width", 1.2},
       {"stroke-linecap", "round"},
       {"stroke-linejoin", "round"}});
}

}  // namespace

bool Area::holds(const Point& point) const {
  constexpr double rounding = 1e-6;
  return point.x >= x.begin - rounding && point.x <= x.end + rounding &&
         point.y <= y.begin + rounding && point.y >= y.end - rounding;
}

std::vector<std::vector<Point>> lines_of(const Curve& curve, const Area& area) {
  const std::vector<Point> corners = corners_of(curve, area);
  std::vector<std::vector<Point>> lines;
  bool joined = false;  // whether the next segment begins where the last one ended
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const bool placed = is_finite(corners[i - 1]) && is_finite(corners[i]);
    const auto segment = placed ? clipped(corners[i - 1], corners[i], area) : std::nullopt;
    if (!segment) {
      joined = false;
      continue;
    }
    const auto& [from, to] = *segment;
    if (!joined || !look_equal(lines.back().back(), from)) lines.push_back({from});
    const bool last = i + 1 == corners.size();
    if (!look_equal(lines.back().back(), to) || (last && lines.back().size() == 1)) {
      lines.back().push_back(to);
    }
    joined = true;
  }
  return lines;
}

void draw_curve(pugi::xml_node parent, const Curve& curve, std::size_t colour, const Area& area,
                const ColouredRange& colours) {
  if (!curve.error.empty()) draw_error_bars(parent, curve, curve_colour(colour), area);
  if (curve.style == Curve::Style::points) {
    draw_points(parent, curve, colour, area, colours);
    return;
  }
  std::string path;
  for (const std::vector<Point>& line : lines_of(curve, area)) path += path_of(line);
  if (!path.empty()) draw_line(parent, path, curve, curve_colour(colour));
}

void draw_map(pugi::xml_node parent, const Map& map, const Area& area,
              const ColouredRange& colours) {
  // One path for each colour makes the text much shorter than a rectangle for each value.
  std::map<std::string, std::string> paths;
  const std::size_t columns = map.x_edges.empty() ? 0 : map.x_edges.size() - 1;
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    if (std::isnan(colours.share(map.values[i]))) continue;
    Point a = area(map.x_edges[i % columns], map.y_edges[i / columns]);
    Point b = area(map.x_edges[i % columns + 1], map.y_edges[i / columns + 1]);
    if (!is_finite(a) || !is_finite(b)) continue;
    for (Point* corner : {&a, &b}) {
      corner->x = std::clamp(corner->x, area.x.begin, area.x.end);
      corner->y = std::clamp(corner->y, area.y.end, area.y.begin);
    }
    if (look_equal(a, b)) continue;
    paths[hex(colours(map.values[i]))] += fmt::format("M{} {}H{}V{}H{}z", pixels(a.x), pixels(a.y),
                                                      pixels(b.x), pixels(b.y), pixels(a.x));
  }
  pugi::xml_node group = add(parent, "g", {{"shape-rendering", "crispEdges"}});
  for (const auto& [colour, path] : paths) add(group, "path", {{"d", path}, {"fill", colour}});
}

void draw_contours(pugi::xml_node parent, const Map& map, const std::vector<Tick>& levels,
                   const Area& area, const ColouredRange& colours) {
  pugi::xml_node group = add(parent, "g", {{"fill", "none"}, {"stroke-opacity", "0.7"}});
  for (const Tick& level : levels) {
    if (level.label.empty()) continue;
    std::string path;
    for (const auto& [from, to] : contour(map, level.value, area)) {
      if (const auto part = clipped(from, to, area)) path += path_of({part->first, part->second});
    }
    const Colour on = is_light(colours(level.value)) ? ink : Colour{0xff, 0xff, 0xff};
    if (!path.empty()) add(group, "path", {{"d", path}, {"stroke", on}});
  }
}

double longest_arrow(const Arrows& arrows) {
  double longest = 0;
  for (std::size_t i = 0; i < arrows.x.size(); ++i) {
    const double length = std::hypot(arrows.u[i], arrows.v[i]);
    if (std::isfinite(length)) longest = std::max(longest, length);
  }
  return longest;
}

void draw_arrows(pugi::xml_node parent, const Arrows& arrows, const Area& area) {
  const double longest = longest_arrow(arrows);
  const double cell = arrows.cell / (area.x.range.high - area.x.range.low) *
                      (area.x.end - area.x.begin);  // [pixels]
  std::string path;
  for (std::size_t i = 0; i < arrows.x.size(); ++i) {
    const Point middle = area(arrows.x[i], arrows.y[i]);
    const double length = std::hypot(arrows.u[i], arrows.v[i]) / longest * cell;
    if (!is_finite(middle) || !area.holds(middle) || !(length > 0.5)) continue;
    const Point half{arrows.u[i] / longest * cell / 2, -arrows.v[i] / longest * cell / 2};
    path +=
        arrow_path({middle.x - half.x, middle.y - half.y}, {middle.x + half.x, middle.y + half.y});
  }
  draw_arrow_paths(parent, path);
}

void draw_sample(pugi::xml_node parent, const Curve& curve, std::size_t colour, Point place) {
  // Two values in an area of the size of the sample.
  const Area area{{{0, 1}, false, place.x, place.x + sample_width},
                  {{0, 1}, false, place.y + 5, place.y - 5}};
  Curve sample;
  sample.style = curve.style;
  if (curve.style == Curve::Style::points) {
    sample.x = {0.5};
    sample.y = {0.5};
    if (!curve.error.empty()) sample.error = {0.5};
  } else if (curve.style == Curve::Style::steps) {
    sample.x = {0, 0.5, 1};
    sample.y = {0.1, 0.9};
  } else {
    sample.x = {0, 1};
    sample.y = {0.5, 0.5};
  }
  if (!curve.values.empty()) sample.values = {0.5};
  draw_curve(parent, sample, colour, area, {{}, sequential_gradient()});
}

void draw_arrow_sample(pugi::xml_node parent, Point place) {
  draw_arrow_paths(parent, arrow_path(place, {place.x + sample_width, place.y}));
}

}  // namespace needlework::picture
