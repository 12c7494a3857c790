#include "src/picture/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <stdexcept>

#include "src/picture/panel.h"
#include "src/picture/svg_document.h"

namespace needlework::picture {
namespace {

constexpr double edge = 8, title_height = 30;  // [pixels]

void require_equal(std::size_t size, std::size_t expected, std::string_view what,
                   const std::string& place) {
  if (size == expected) return;
  throw std::invalid_argument(
      fmt::format("{}: {}: {} values: expected {}", place, what, size, expected));
}

void require_sizes(const Curve& curve, const std::string& place) {
  const bool steps = curve.style == Curve::Style::steps && !curve.y.empty();
  require_equal(curve.x.size(), curve.y.size() + steps, "x", place);
  if (!curve.error.empty()) require_equal(curve.error.size(), curve.y.size(), "error", place);
  if (!curve.values.empty()) require_equal(curve.values.size(), curve.y.size(), "values", place);
}

void require_sizes(const Panel& panel, const std::string& place) {
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    require_sizes(panel.curves[i],
                  fmt::format("{}, curve {} '{}'", place, i, panel.curves[i].name));
  }
  if (panel.map) {
    const auto cells = [](const std::vector<double>& edges) {
      return edges.empty() ? 0 : edges.size() - 1;
    };
    require_equal(panel.map->values.size(), cells(panel.map->x_edges) * cells(panel.map->y_edges),
                  "map", place);
  }
  if (panel.arrows) {
    const Arrows& arrows = *panel.arrows;
    require_equal(arrows.y.size(), arrows.x.size(), "y of arrows", place);
    require_equal(arrows.u.size(), arrows.x.size(), "u of arrows", place);
    require_equal(arrows.v.size(), arrows.x.size(), "v of arrows", place);
  }
}

std::string axis_text(const Axis& axis) {
  const std::string name = axis.label.empty() ? "an axis without a name" : axis.label;
  return axis.logarithmic ? name + " (logarithmic)" : name;
}

// What can be said of a chart without seeing it.
std::string description_of(const Chart& chart) {
  if (!chart.description.empty()) return chart.description;
  std::string text;
  for (const Panel& panel : chart.panels) {
    if (!text.empty()) text += " ";
    if (!panel.title.empty()) text += panel.title + ": ";
    text += fmt::format("{} against {}", axis_text(panel.y), axis_text(panel.x));
    if (panel.map) text += fmt::format(", with {} as colours", panel.colours.label);
    std::string names;
    for (const Curve& curve : panel.curves) {
      if (!curve.name.empty()) names += (names.empty() ? "; " : ", ") + curve.name;
    }
    text += names + ".";
  }
  return text;
}

struct Column {
  double left = 0, inside = 0, right = 0;
};
struct Row {
  double top = 0, inside = 0, bottom = 0;
};

// The panels in rows; axes below each other are aligned.
class Grid {
 public:
  Grid(const Chart& chart) : chart_(chart) {
    const std::size_t in_a_row = chart.columns == 0 ? chart.panels.size() : chart.columns;
    columns_.resize(std::min(in_a_row, chart.panels.size()));
    for (std::size_t i = 0; i < chart.panels.size(); ++i) {
      const PanelLayout& layout =
          layouts_.emplace_back(chart.panels[i], chart.panel_width, chart.panel_height);
      const Margins margins = layout.margins();
      Column& column = columns_[i % columns_.size()];
      column.left = std::max(column.left, margins.left);
      column.inside = chart.panel_width;
      column.right = std::max(column.right, margins.right);
      if (i % columns_.size() == 0) rows_.emplace_back();
      rows_.back().top = std::max(rows_.back().top, margins.top);
      rows_.back().inside = std::max(rows_.back().inside, layout.height());
      rows_.back().bottom = std::max(rows_.back().bottom, margins.bottom);
    }
  }

  double width() const {
    double width = 2 * edge;
    for (const Column& column : columns_) width += column.left + column.inside + column.right;
    return std::max(width, text_width(chart_.title, 17) + 4 * edge);
  }
  double height() const {
    double height = 2 * edge + (chart_.title.empty() ? 0 : title_height);
    for (const Row& row : rows_) height += row.top + row.inside + row.bottom;
    return height;
  }

  void draw(pugi::xml_node root) const {
    double y = edge + (chart_.title.empty() ? 0 : title_height);
    for (std::size_t first = 0; first < layouts_.size(); first += columns_.size()) {
      const Row& row = rows_[first / columns_.size()];
      double x = edge;
      for (std::size_t i = first; i < std::min(first + columns_.size(), layouts_.size()); ++i) {
        const Column& column = columns_[i - first];
        const std::string place =
            fmt::format("translate({} {})", pixels(x + column.left), pixels(y + row.top));
        layouts_[i].draw(add(root, "g", {{"transform", place}}));
        x += column.left + column.inside + column.right;
      }
      y += row.top + row.inside + row.bottom;
    }
  }

 private:
  const Chart& chart_;
  std::deque<PanelLayout> layouts_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

}  // namespace

std::string svg(const Chart& chart) {
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    require_sizes(chart.panels[i], fmt::format("panel {} '{}'", i, chart.panels[i].title));
  }
  const Grid grid(chart);
  const double width = grid.width(), height = grid.height();
  const SvgDocument document(width, height, chart.title, description_of(chart));
  add(document.root(), "rect", {{"width", width}, {"height", height}, {"fill", "#ffffff"}});
  if (!chart.title.empty()) {
    add_text(document.root(), width / 2, edge + 20, chart.title,
             {.size = 17, .anchor = "middle", .bold = true});
  }
  grid.draw(document.root());
  return document.text();
}

}  // namespace needlework::picture
