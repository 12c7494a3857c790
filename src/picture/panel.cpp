#include "src/picture/panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "src/picture/svg_document.h"

namespace needlework::picture {
namespace {

constexpr double tick_size = 12, label_size = 13, title_size = 14;  // of texts [pixels]
constexpr double row_height = 18;                                   // of the legend
constexpr double bar_gap = 14, bar_thickness = 12;                  // of the bar of colours
constexpr double margin_of_data = 0.04;
constexpr Colour grey{0xdd, 0xdd, 0xdd};

double widest(const std::vector<Tick>& ticks) {
  double width = 0;
  for (const Tick& tick : ticks) width = std::max(width, text_width(tick.label, tick_size));
  return width;
}

double width_of_entry(const std::string& text) {
  return sample_width + 7 + text_width(text, tick_size) + 7;
}

// Data fill the axes of maps to their edges; others have a margin.
Range range_of(const Axis& axis, const RangeOfValues& data, bool to_the_edges) {
  if (axis.range) return usable_range(*axis.range, axis.logarithmic);
  return data.range(to_the_edges ? 0 : margin_of_data);
}

}  // namespace

PanelLayout::PanelLayout(const Panel& panel, double width, double height) : panel_(panel) {
  choose_scales(width, height);
  choose_colours();
  place_legend();
}

void PanelLayout::choose_scales(double width, double height) {
  RangeOfValues x(panel_.x.logarithmic), y(panel_.y.logarithmic);
  for (const Curve& curve : panel_.curves) {
    x.add(curve.x);
    y.add(curve.y);
    for (std::size_t i = 0; i < curve.error.size(); ++i) {
      y.add(curve.y[i] - curve.error[i]);
      y.add(curve.y[i] + curve.error[i]);
    }
  }
  if (panel_.map) {
    x.add(panel_.map->x_edges);
    y.add(panel_.map->y_edges);
  }
  if (panel_.arrows) {
    const double half = panel_.arrows->cell / 2;
    for (const double value : panel_.arrows->x) x.add(value - half), x.add(value + half);
    for (const double value : panel_.arrows->y) y.add(value - half), y.add(value + half);
  }
  const bool to_the_edges = panel_.map || panel_.arrows;
  const Range x_range = range_of(panel_.x, x, to_the_edges);
  const Range y_range = range_of(panel_.y, y, to_the_edges);
  if (panel_.equal_scales && !panel_.x.logarithmic && !panel_.y.logarithmic) {
    const double ratio = (y_range.high - y_range.low) / (x_range.high - x_range.low);
    height = width * std::clamp(ratio, 0.1, 10.0);
  }
  area_.x = {x_range, panel_.x.logarithmic, 0, width};
  area_.y = {y_range, panel_.y.logarithmic, height, 0};
  x_ticks_ = ticks(x_range, panel_.x.logarithmic, std::max(2, static_cast<int>(width / 50)));
  y_ticks_ = ticks(y_range, panel_.y.logarithmic, std::max(2, static_cast<int>(height / 35)));
}

void PanelLayout::choose_colours() {
  const ColourScale& scale = panel_.colours;
  RangeOfValues values(scale.logarithmic);
  if (panel_.map) values.add(panel_.map->values);
  has_bar_ = panel_.map.has_value();
  for (const Curve& curve : panel_.curves) {
    values.add(curve.values);
    has_bar_ = has_bar_ || !curve.values.empty();
  }
  Range range = values.range();
  if (scale.diverging && !scale.logarithmic) {
    const double greatest = std::max(std::abs(range.low), std::abs(range.high));
    range = {-greatest, greatest};
  }
  if (scale.range) range = *scale.range;
  range = usable_range(range, scale.logarithmic);
  colours_ = {{range, scale.logarithmic, 0, 1},
              scale.diverging ? diverging_gradient() : sequential_gradient()};
  if (has_bar_) colour_ticks_ = ticks(range, scale.logarithmic, 8);
}

std::size_t PanelLayout::colour_of(std::size_t curve) const {
  return panel_.curves[curve].colour.value_or(curve);
}

void PanelLayout::choose_legend_entries() {
  for (std::size_t i = 0; i < panel_.curves.size(); ++i) {
    if (!panel_.curves[i].name.empty()) entries_.push_back({i, panel_.curves[i].name});
  }
  if (panel_.arrows && !panel_.arrows->name.empty()) {
    entries_.push_back({panel_.curves.size(), fmt::format("{}: {:.3g}", panel_.arrows->name,
                                                          longest_arrow(*panel_.arrows))});
  }
}

// In the corner where it hides nothing, or else below the axis.
void PanelLayout::place_legend() {
  choose_legend_entries();
  if (entries_.empty()) return;
  for (const LegendEntry& entry : entries_) {
    legend_width_ = std::max(legend_width_, width_of_entry(entry.text));
  }
  legend_width_ += 6;
  legend_height_ = static_cast<double>(entries_.size()) * row_height + 8;

  constexpr double gap = 8;
  const double right = area_.x.end - legend_width_ - gap;
  const double bottom = area_.y.begin - legend_height_ - gap;
  legend_below_ = panel_.map || panel_.arrows || right < gap || bottom < gap;
  if (!legend_below_) {
    const std::array corners{Point{right, gap}, Point{gap, bottom}, Point{right, bottom},
                             Point{gap, gap}};
    legend_ = *std::min_element(corners.begin(), corners.end(),
                                [&](Point a, Point b) { return covered(a) < covered(b); });
    legend_below_ = covered(legend_) > 0;
  }
  if (legend_below_) return place_below();
  double y = legend_.y + 4 + row_height / 2;
  for (LegendEntry& entry : entries_) {
    entry.place = {legend_.x + 6, y};
    y += row_height;
  }
}

// In rows as long as the axis.
void PanelLayout::place_below() {
  legend_ = {0, area_.y.begin + height_below()};
  double x = 0, y = legend_.y + row_height / 2;
  for (LegendEntry& entry : entries_) {
    if (x > 0 && x + width_of_entry(entry.text) > area_.x.end) {
      x = 0;
      y += row_height;
    }
    entry.place = {x, y};
    x += width_of_entry(entry.text) + 6;
  }
  legend_height_ = y + row_height / 2 - legend_.y;
}

// How much of the curves a legend in this place would hide [points and pixels of lines].
double PanelLayout::covered(Point corner) const {
  const auto hides = [&](const Point& p) {
    return p.x > corner.x - 4 && p.x < corner.x + legend_width_ + 4 && p.y > corner.y - 4 &&
           p.y < corner.y + legend_height_ + 4;
  };
  double hidden = 0;
  for (const Curve& curve : panel_.curves) {
    if (curve.style == Curve::Style::points) {
      for (std::size_t i = 0; i < curve.y.size(); ++i) {
        hidden += hides(area_(curve.x[i], curve.y[i]));
      }
      continue;
    }
    for (const std::vector<Point>& line : lines_of(curve, area_)) {
      for (std::size_t i = 1; i < line.size(); ++i) {
        const Point d{line[i].x - line[i - 1].x, line[i].y - line[i - 1].y};
        const double steps = std::ceil(std::hypot(d.x, d.y) / 4) + 1;
        for (double step = 0; step <= steps; ++step) {
          hidden += hides({line[i - 1].x + step / steps * d.x, line[i - 1].y + step / steps * d.y});
        }
      }
    }
  }
  return hidden;
}

double PanelLayout::bar_width() const {
  if (!has_bar_) return 0;
  const double label = panel_.colours.label.empty() ? 0 : 1.5 * label_size;
  return bar_gap + bar_thickness + 7 + widest(colour_ticks_) + label;
}

// Of the ticks and the label of the x axis.
double PanelLayout::height_below() const {
  return 30 + (panel_.x.label.empty() ? 0 : 1.4 * label_size);
}

Margins PanelLayout::margins() const {
  Margins margins;
  margins.left = 18 + widest(y_ticks_) + (panel_.y.label.empty() ? 0 : 1.5 * label_size);
  margins.bottom = height_below() + (legend_below_ ? legend_height_ + 4 : 0);
  margins.top = panel_.title.empty() ? 12 : 32;
  margins.right = 16 + bar_width();
  return margins;
}

void PanelLayout::draw(pugi::xml_node group) const {
  draw_axes(group);
  if (panel_.map) draw_map(group, *panel_.map, area_, colours_);
  if (panel_.map && panel_.map->contours)
    draw_contours(group, *panel_.map, colour_ticks_, area_, colours_);
  for (std::size_t i = 0; i < panel_.curves.size(); ++i) {
    draw_curve(group, panel_.curves[i], colour_of(i), area_, colours_);
  }
  if (panel_.arrows) draw_arrows(group, *panel_.arrows, area_);
  add(group, "rect",
      {{"width", area_.x.end}, {"height", area_.y.begin}, {"fill", "none"}, {"stroke", ink}});
  if (!panel_.title.empty()) {
    add_text(group, area_.x.end / 2, -12, panel_.title,
             {.size = title_size, .anchor = "middle", .bold = true});
  }
  if (has_bar_) draw_bar(group);
  if (!entries_.empty()) draw_legend(group);
}

void PanelLayout::draw_axes(pugi::xml_node group) const {
  std::string grid, marks;
  const double width = area_.x.end, height = area_.y.begin;
  for (const Tick& tick : x_ticks_) {
    const std::string x = pixels(area_.x(tick.value));
    marks += fmt::format("M{} {}v{}", x, pixels(height), tick.label.empty() ? 3 : 6);
    if (tick.label.empty()) continue;
    grid += fmt::format("M{} 0v{}", x, pixels(height));
    add_text(group, area_.x(tick.value), height + 20, tick.label,
             {.size = tick_size, .anchor = "middle"});
  }
  for (const Tick& tick : y_ticks_) {
    const std::string y = pixels(area_.y(tick.value));
    marks += fmt::format("M0 {}h{}", y, tick.label.empty() ? -3 : -6);
    if (tick.label.empty()) continue;
    grid += fmt::format("M0 {}h{}", y, pixels(width));
    add_text(group, -9, area_.y(tick.value) + 0.35 * tick_size, tick.label,
             {.size = tick_size, .anchor = "end"});
  }
  add(group, "path", {{"d", grid}, {"fill", "none"}, {"stroke", grey}, {"stroke-width", 0.8}});
  add(group, "path", {{"d", marks}, {"fill", "none"}, {"stroke", ink}});
  const TextStyle label{.size = label_size, .anchor = "middle"};
  if (!panel_.x.label.empty()) {
    add_text(group, width / 2, height + 24 + 1.3 * label_size, panel_.x.label, label);
  }
  if (!panel_.y.label.empty()) {
    TextStyle turned = label;
    turned.turned = -90;
    add_text(group, -18 - widest(y_ticks_), height / 2, panel_.y.label, turned);
  }
}

void PanelLayout::draw_bar(pugi::xml_node group) const {
  const double left = area_.x.end + bar_gap, height = area_.y.begin;
  // Of strips rather than a gradient, which would need a name that is unique where several pictures
  // are part of one page.
  constexpr int strips = 96;
  pugi::xml_node bar = add(group, "g", {{"shape-rendering", "crispEdges"}});
  for (int i = 0; i < strips; ++i) {
    const Colour colour = colour_at(colours_.gradient, (i + 0.5) / strips);
    add(bar, "rect",
        {{"x", left},
         {"y", height * (strips - 1 - i) / strips},
         {"width", bar_thickness},
         {"height", height / strips + 0.5},
         {"fill", colour}});
  }
  add(group, "rect",
      {{"x", left},
       {"width", bar_thickness},
       {"height", height},
       {"fill", "none"},
       {"stroke", ink}});
  Scale scale = colours_.share;
  scale.begin = height;
  scale.end = 0;
  const double right = left + bar_thickness;
  std::string marks;
  for (const Tick& tick : colour_ticks_) {
    const double y = scale(tick.value);
    marks += fmt::format("M{} {}h{}", pixels(right), pixels(y), tick.label.empty() ? 2 : 4);
    if (tick.label.empty()) continue;
    add_text(group, right + 7, y + 0.35 * tick_size, tick.label, {.size = tick_size});
  }
  add(group, "path", {{"d", marks}, {"fill", "none"}, {"stroke", ink}});
  if (!panel_.colours.label.empty()) {
    add_text(group, right + 7 + widest(colour_ticks_) + 1.2 * label_size, height / 2,
             panel_.colours.label, {.size = label_size, .anchor = "middle", .turned = -90});
  }
}

void PanelLayout::draw_legend(pugi::xml_node group) const {
  pugi::xml_node legend = add(group, "g");
  if (!legend_below_) {
    add(legend, "rect",
        {{"x", legend_.x},
         {"y", legend_.y},
         {"width", legend_width_},
         {"height", legend_height_},
         {"fill", "#ffffff"},
         {"stroke", grey},
         {"rx", 3.0}});
  }
  for (const auto& [curve, text, place] : entries_) {
    if (curve < panel_.curves.size()) {
      draw_sample(legend, panel_.curves[curve], colour_of(curve), place);
    } else {
      draw_arrow_sample(legend, place);
    }
    add_text(legend, place.x + sample_width + 7, place.y + 0.35 * tick_size, text,
             {.size = tick_size});
  }
}

}  // namespace needlework::picture
