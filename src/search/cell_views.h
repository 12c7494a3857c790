// The cells that a search looks into.
//
// Why none is left out that holds an entry within reach: a cell is as far from the box around a
// segment, along each axis, as its layer is, and entries are in their cells or, within the overlap,
// beside them. Where a box has many cells, those are chosen that are near the segment itself: the
// part of it near a layer, of that near a row, of that near a cell. Both leave room for rounding in
// Look::reach.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "src/memory/prefetch.h"
#include "src/search/look.h"

namespace needlework {

/// The segment that a needle sweeps, among the cells around it: which are within its reach.
class SegmentInCells {
 public:
  /// Of the segment, as shares of its length; none if the end is before the begin.
  struct Part {
    float begin = 0, end = 1;
  };
  using AxisCells = std::span<const CellGrid::AxisCell>;

  /// `direction` need have the signs only.
  SegmentInCells(const Look& look, const float* direction, float overlap, double per_length)
      : overlap_(overlap),
        // Has room for what rounding does to parts.
        wide_(look.reach * (1 + 0x1p-8f) + overlap + look.seeker.margin) {
    for (int axis = 0; axis < 3; ++axis) {
      side_[axis] = static_cast<float>(look.cells->grid.sides()[axis] * per_length);
      const float length = look.high[axis] - look.low[axis];
      const bool backwards = direction[axis] < 0;
      from_[axis] = backwards ? look.high[axis] : look.low[axis];
      way_[axis] = backwards ? -length : length;
      per_side_[axis] = 1 / side_[axis];
      per_way_[axis] = 1 / way_[axis];
    }
  }

  /// The part that comes near the layer of cells, from these parts of the segment.
  Part near(int axis, const CellGrid::AxisCell& cell, Part part) const {
    const float low = cell.offset - wide_ - from_[axis],
                high = cell.offset + side_[axis] + wide_ - from_[axis], way = way_[axis];
    const float first = low * per_way_[axis], last = high * per_way_[axis];
    if (way > 0) return {std::max(part.begin, first), std::min(part.end, last)};
    if (way < 0) return {std::max(part.begin, last), std::min(part.end, first)};
    return low <= 0 && high >= 0 ? part : Part{1, 0};
  }
  /// Those of the cells of an axis, which are in a row, that come near this part.
  AxisCells cells_near(int axis, Part part, AxisCells cells) const {
    if (part.end < part.begin) return {};
    const Interval at = interval(axis, part);
    const auto count_before = [&](float place) {
      const float cells_before = (place - cells.front().offset) * per_side_[axis];
      return static_cast<std::size_t>(
          std::clamp(cells_before, 0.0f, static_cast<float>(cells.size())));
    };
    const std::size_t first = count_before(at.low - wide_),
                      last = count_before(at.high + wide_ + side_[axis]);
    return cells.subspan(first, last - first);
  }
  /// Of the distance along an axis of this part from where needles of the cell may be.
  float gap_squared(int axis, const CellGrid::AxisCell& cell, Part part) const {
    const Interval at = interval(axis, part);
    const float gap =
        std::max({cell.offset - at.high, at.low - (cell.offset + side_[axis]), overlap_}) -
        overlap_;
    return gap * gap;
  }

 private:
  struct Interval {
    float low, high;
  };
  Interval interval(int axis, Part part) const {
    const float a = from_[axis] + way_[axis] * part.begin, b = from_[axis] + way_[axis] * part.end;
    return {std::min(a, b), std::max(a, b)};
  }

  float overlap_, wide_, side_[3], per_side_[3], from_[3], way_[3], per_way_[3];
};

/// Views of the cells that one search looks into, by the kernels' numbers, and which cells those
/// are.
class CellViews {
 public:
  using AxisCells = SegmentInCells::AxisCells;

  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  const kernels::CellView* data() const { return views_.data(); }
  /// The cell of a view, not wrapped into the box.
  const Cell& cell(std::uint32_t view) const { return cells_[view]; }

  /// Adds those of all cells within reach of the look's box; There is the kind of the bounding
  /// volumes in them.
  template <class There>
  void add_around_box(Look& look, double per_length) {
    const Layers near = layers_near(look, per_length);
    add_around_box<There>(look, near);
  }
  /// The layers of cells along y that are within reach of the look's box, for add_in_row().
  AxisCells rows_near(const Look& look, double per_length) {
    const float overlap = overlap_of(look, per_length);
    along_z_ = find_near(look, 2, overlap, per_length);
    return find_near(look, 1, overlap, per_length);
  }
  /// The cells of one of these rows that are within reach of the look's box, which may be as much
  /// wider along x; that alone may have changed since.
  template <class There>
  void add_in_row(Look& look, const CellGrid::AxisCell& row, float wider, double per_length) {
    const float overlap = overlap_of(look, per_length) + wider;
    const Layers near{{find_near(look, 0, overlap, per_length), {&row, 1}, along_z_}, overlap};
    make_room(near);
    add_around_box<There>(look, near);
  }
  /// The same, where there are many, within reach of the segment in the box.
  template <class There>
  void add_around_segment(Look& look, const float* direction, double per_length) {
    const Layers near = layers_near(look, per_length);
    if (near.cells() < many_cells) return add_around_box<There>(look, near);
    const SegmentInCells segment(look, direction, near.overlap, per_length);
    const float reach_squared = look.reach * look.reach;
    Writer<There> write(*this, look);
    for (const auto& z : near[2]) {
      const SegmentInCells::Part in_layer = segment.near(2, z, {});
      for (const auto& y : segment.cells_near(1, in_layer, near[1])) {
        const SegmentInCells::Part in_row = segment.near(1, y, in_layer);
        const float gap_squared = z.gap_squared + segment.gap_squared(1, y, in_layer);
        if (gap_squared > reach_squared) continue;
        const std::size_t row = look.cells->grid.index(0, y.wrapped, z.wrapped);
        for (const auto& x : segment.cells_near(0, in_row, near[0])) {
          if (gap_squared + segment.gap_squared(0, x, in_row) > reach_squared) continue;
          write(z, y, x, row);
        }
      }
    }
    finish(look, write.count());
  }

 private:
  // Of a box of more cells, those are found that are near the segment in it. Fewer are looked
  // through sooner.
  static constexpr std::size_t many_cells = 12;

  // By axis: the layers of cells that are within reach of the box.
  struct Layers {
    AxisCells along[3];
    float overlap;

    const AxisCells& operator[](int axis) const { return along[axis]; }
    std::size_t cells() const { return along[0].size() * along[1].size() * along[2].size(); }
  };
  static float overlap_of(const Look& look, double per_length) {
    return static_cast<float>(look.cells->overlap * per_length);
  }
  AxisCells find_near(const Look& look, int axis, float overlap, double per_length) {
    const std::size_t count =
        look.cells->grid.find_near(axis, look.origin[axis], look.low[axis] - overlap,
                                   look.high[axis] + overlap, look.reach, per_length, near_[axis]);
    return {near_[axis].data(), count};
  }
  Layers layers_near(const Look& look, double per_length) {
    Layers out;
    out.overlap = overlap_of(look, per_length);
    for (int axis = 0; axis < 3; ++axis)
      out.along[axis] = find_near(look, axis, out.overlap, per_length);
    make_room(out);
    return out;
  }
  void make_room(const Layers& near) {
    const std::size_t most = count_ + near.cells();
    if (most <= views_.size()) return;
    views_.resize(most);
    cells_.resize(most);
  }

  // Writes views, and prefetches what kernels will read of their cells.
  template <class There>
  class Writer {
   public:
    Writer(CellViews& all, const Look& look)
        : blocks_(look.cells->cells.blocks()),
          first_(all.views_.data() + all.count_),
          view_(first_),
          cell_(all.cells_.data() + all.count_) {}

    void operator()(const CellGrid::AxisCell& z, const CellGrid::AxisCell& y,
                    const CellGrid::AxisCell& x, std::size_t row) {
      const auto block = static_cast<std::uint32_t>(row + x.wrapped);
      There::prefetch(blocks_[block]);
      *view_++ = {block, {x.offset, y.offset, z.offset}};
      *cell_++ = {x.cell, y.cell, z.cell};
    }
    std::size_t count() const { return static_cast<std::size_t>(view_ - first_); }

   private:
    const kernels::NeedleBlock* blocks_;
    kernels::CellView *first_, *view_;
    Cell* cell_;
  };

  template <class There>
  void add_around_box(Look& look, const Layers& near) {
    const float reach_squared = look.reach * look.reach;
    Writer<There> write(*this, look);
    // Copies, because for all the compiler knows the stores might change what these are.
    for (const CellGrid::AxisCell z : near[2]) {
      for (const CellGrid::AxisCell y : near[1]) {
        const float gap_squared = z.gap_squared + y.gap_squared;
        if (gap_squared > reach_squared) continue;
        const std::size_t row = look.cells->grid.index(0, y.wrapped, z.wrapped);
        for (const CellGrid::AxisCell& x : near[0]) {
          if (gap_squared + x.gap_squared > reach_squared) continue;
          write(z, y, x, row);
        }
      }
    }
    finish(look, write.count());
  }
  void finish(Look& look, std::size_t added) {
    look.first_view = count_;
    look.views = added;
    count_ += added;
  }

  std::vector<CellGrid::AxisCell> near_[3];
  AxisCells along_z_;  ///< of those within reach of all rows
  std::vector<kernels::CellView> views_;
  std::vector<Cell> cells_;
  std::size_t count_ = 0;
};

}  // namespace needlework
