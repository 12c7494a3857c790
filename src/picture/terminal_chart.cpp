#include "src/picture/terminal_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/picture/point.h"

namespace needlework::picture {
namespace {

// Cyan, yellow, green, magenta, blue and red, in the shades that the terminal has.
constexpr std::array<int, 6> ansi_colours{36, 33, 32, 35, 34, 31};

// One character of the chart, and the curve that was drawn into it last.
struct Cell {
  unsigned dots = 0;  // of braille, as in its code point
  bool point = false;
  std::size_t colour = 0;
};

std::string utf8_braille(unsigned dots) {
  const unsigned code = 0x2800 + dots;
  return {static_cast<char>(0xe0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3f)),
          static_cast<char>(0x80 | (code & 0x3f))};
}

std::string coloured(const std::string& text, std::size_t colour, bool colours) {
  if (!colours || text.empty()) return text;
  return fmt::format("\033[{}m{}\033[0m", ansi_colours[colour % ansi_colours.size()], text);
}

std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

std::string right_aligned(const std::string& text, std::size_t columns) {
  return std::string(columns - std::min(columns, columns_of(text)), ' ') + text;
}

bool is_finite(const Point& point) { return std::isfinite(point.x) && std::isfinite(point.y); }

/// The scales of the area of dots, x from left to right and y from the bottom up.
struct Area {
  Scale x, y;

  Point operator()(double x_value, double y_value) const { return {x(x_value), y(y_value)}; }
  bool holds(const Point& point) const {
    constexpr double rounding = 1e-6;
    return point.x >= x.begin - rounding && point.x <= x.end + rounding &&
           point.y <= y.begin + rounding && point.y >= y.end - rounding;
  }
};

// The part of a segment inside the area, by the method of Liang and Barsky.
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

class TerminalChart {
 public:
  TerminalChart(const Panel& panel, TerminalSize size, bool colours)
      : panel_(panel), size_(size), colours_(colours) {
    rows_ = size.rows - 3;  // title, axis and numbers
    const Range y = range(panel.y, &Curve::y, 0.02);
    y_ticks_ = ticks(y, panel.y.logarithmic, std::max(2, static_cast<int>(rows_ / 3)));
    for (const Tick& tick : y_ticks_) left_ = std::max(left_, columns_of(tick.label));
    left_ = std::min(left_, size.columns / 2);
    columns_ = size.columns - left_ - 1;
    const Range x = range(panel.x, &Curve::x, 0);
    x_ticks_ = ticks(x, panel.x.logarithmic, std::max(2, static_cast<int>(columns_ / 9)));
    cells_.resize(rows_ * columns_);
    area_.x = {x, panel.x.logarithmic, 0, 2.0 * static_cast<double>(columns_) - 1};
    area_.y = {y, panel.y.logarithmic, 4.0 * static_cast<double>(rows_) - 1, 0};
  }

  std::vector<std::string> lines() {
    for (std::size_t i = 0; i < panel_.curves.size(); ++i) draw(panel_.curves[i], colour_of(i));
    std::vector<std::string> lines{title()};
    for (std::size_t row = 0; row < rows_; ++row) lines.push_back(line(row));
    lines.push_back(axis());
    lines.push_back(numbers());
    return lines;
  }

 private:
  Range range(const Axis& axis, std::vector<double> Curve::*values, double margin) const {
    if (axis.range) return usable_range(*axis.range, axis.logarithmic);
    RangeOfValues all(axis.logarithmic);
    for (const Curve& curve : panel_.curves) all.add(curve.*values);
    return all.range(margin);
  }

  std::size_t colour_of(std::size_t curve) const {
    return panel_.curves[curve].colour.value_or(curve);
  }

  // The character at a dot, which counts from the upper left corner.
  Cell& cell(long x, long y) {
    return cells_[static_cast<std::size_t>(y / 4) * columns_ + static_cast<std::size_t>(x / 2)];
  }

  void draw(const Curve& curve, std::size_t colour) {
    const bool points = curve.style == Curve::Style::points;
    Point last{NAN, NAN};
    for (std::size_t i = 0; i < curve.y.size(); ++i) {
      const Point at = area_(curve.x[i], curve.y[i]);
      if (points) draw_point(at, colour);
      if (!points && is_finite(last) && is_finite(at)) draw_segment(last, at, colour);
      last = at;
    }
  }

  void draw_point(Point at, std::size_t colour) {
    if (!is_finite(at) || !area_.holds(at)) return;
    Cell& marked = cell(std::lround(at.x), std::lround(at.y));
    marked.point = true;
    marked.colour = colour;
  }

  void draw_segment(Point from, Point to, std::size_t colour) {
    // Bits of the dots of a braille character, by row and column.
    constexpr unsigned bits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    const auto inside = clipped(from, to, area_);
    if (!inside) return;
    const Point a = inside->first, d{inside->second.x - a.x, inside->second.y - a.y};
    const double steps = std::ceil(std::max({std::abs(d.x), std::abs(d.y), 1.0}));
    for (double step = 0; step <= steps; ++step) {
      const long x = std::lround(a.x + step / steps * d.x);
      const long y = std::lround(a.y + step / steps * d.y);
      Cell& marked = cell(x, y);
      marked.dots |= bits[y % 4][x % 2];
      if (!marked.point) marked.colour = colour;
    }
  }

  // With a legend, as far as there is room for it.
  std::string title() const {
    std::string text = panel_.title;
    std::size_t used = columns_of(text);
    if (used > size_.columns) return right_aligned("", size_.columns);
    for (std::size_t i = 0; i < panel_.curves.size(); ++i) {
      const Curve& curve = panel_.curves[i];
      if (curve.name.empty()) continue;
      const std::string mark = curve.style == Curve::Style::points ? "o" : "⠒⠒";
      const std::string entry = "  " + mark + " " + curve.name;
      if (used + columns_of(entry) > size_.columns) break;
      text += "  " + coloured(mark, colour_of(i), colours_) + " " + curve.name;
      used += columns_of(entry);
    }
    return text + std::string(size_.columns - used, ' ');
  }

  std::string line(std::size_t row) const {
    std::string label, text;
    for (const Tick& tick : y_ticks_) {
      if (std::lround(area_.y(tick.value)) / 4 == static_cast<long>(row)) label = tick.label;
    }
    text = right_aligned(label, left_) + (label.empty() ? "│" : "┤");
    for (std::size_t column = 0; column < columns_; ++column) {
      const Cell& here = cells_[row * columns_ + column];
      if (here.point) {
        text += coloured("o", here.colour, colours_);
      } else {
        text += here.dots == 0 ? " " : coloured(utf8_braille(here.dots), here.colour, colours_);
      }
    }
    return text;
  }

  std::size_t column_of(const Tick& tick) const {
    return static_cast<std::size_t>(std::lround(area_.x(tick.value))) / 2;
  }

  std::string axis() const {
    std::vector<std::string> parts(columns_, "─");
    for (const Tick& tick : x_ticks_) parts[column_of(tick)] = "┴";
    std::string text = std::string(left_, ' ') + "└";
    for (const std::string& part : parts) text += part;
    return text;
  }

  // The numbers of the x axis below their ticks, and its label after them if there is room.
  std::string numbers() const {
    std::string text;
    std::size_t used = 0;
    const auto put = [&](const std::string& label, std::size_t begin) {
      const std::size_t end = begin + columns_of(label);
      if (begin < used + (used > 0) || end > size_.columns) return;
      text += std::string(begin - used, ' ') + label;
      used = end;
    };
    for (const Tick& tick : x_ticks_) {
      const std::size_t middle = left_ + 1 + column_of(tick);
      put(tick.label, middle - std::min(middle, columns_of(tick.label) / 2));
    }
    const std::string& name = panel_.x.label;
    if (columns_of(name) < size_.columns) put(name, size_.columns - columns_of(name));
    return text + std::string(size_.columns - used, ' ');
  }

  const Panel& panel_;
  TerminalSize size_;
  bool colours_;
  std::size_t left_ = 0, columns_ = 0, rows_ = 0;  // of the labels, and of the area of dots
  std::vector<Tick> x_ticks_, y_ticks_;
  Area area_;
  std::vector<Cell> cells_;
};

}  // namespace

std::vector<std::string> terminal_lines(const Panel& panel, TerminalSize size, bool colours) {
  return TerminalChart(panel, size, colours).lines();
}

}  // namespace needlework::picture
