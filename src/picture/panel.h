// One panel of a chart: its scales, ticks, legend and margins.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "src/picture/chart.h"
#include "src/picture/marks.h"

namespace needlework::picture {

/// What a panel needs around the area inside its axes [pixels].
struct Margins {
  double left = 0, right = 0, top = 0, bottom = 0;
};

/// A panel with everything decided that drawing it needs. Refers to the panel.
class PanelLayout {
 public:
  /// The area inside the axes is `width` times `height`, but for panels of equal scales, whose
  /// height follows from the width.
  PanelLayout(const Panel& panel, double width, double height);

  Margins margins() const;
  double height() const { return area_.y.begin; }
  /// Draws into a group whose origin is the upper left corner of the axes.
  void draw(pugi::xml_node group) const;

 private:
  struct LegendEntry {
    std::size_t curve;  ///< number of the curve; that of the arrows is the number of curves
    std::string text;
    Point place{};  ///< of the middle of its left end
  };

  void choose_scales(double width, double height);
  void choose_colours();
  void choose_legend_entries();
  void place_legend();
  void place_below();
  double covered(Point corner) const;
  std::size_t colour_of(std::size_t curve) const;
  void draw_axes(pugi::xml_node group) const;
  void draw_bar(pugi::xml_node group) const;
  void draw_legend(pugi::xml_node group) const;
  double height_below() const;
  double bar_width() const;

  const Panel& panel_;
  Area area_;
  std::vector<Tick> x_ticks_, y_ticks_, colour_ticks_;
  bool has_bar_ = false;
  ColouredRange colours_;
  std::vector<LegendEntry> entries_;
  double legend_width_ = 0, legend_height_ = 0;
  Point legend_{};  ///< its upper left corner
  bool legend_below_ = false;
};

}  // namespace needlework::picture
