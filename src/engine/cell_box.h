// Regions of grid cells: boxes of cells, and all cells within a distance of one cell.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/engine/subdomains.h"
#include "src/search/cell_grid.h"

namespace needlework {

/// A box of cells on a periodic grid.
struct CellBox {
  CellCounts low{};   ///< indices of the lowest cell in the grid
  CellCounts more{};  ///< number of cells beyond `low` along each axis, less than the grid's count
};

/// Whether two boxes are at most `distance` cells apart along every axis.
inline bool near(const CellBox& a, const CellBox& b, const CellCounts& cells,
                 const CellCounts& distance) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t n = cells[axis];
    std::int32_t ahead = b.low[axis] - a.low[axis];
    if (ahead < 0) ahead += n;
    if (ahead > a.more[axis] + distance[axis] && n - ahead > b.more[axis] + distance[axis]) {
      return false;
    }
  }
  return true;
}

/// Whether visit(first, end) returns true for any row of cells of the box, where `first` to `end`
/// - 1 are cell indices. Stops at the first row for which it does. A row that crosses the border
/// of the grid is visited in two parts.
template <class Visit>
bool any_row_in(const CellBox& box, const CellCounts& cells, Visit&& visit) {
  const std::int32_t length = box.more[0] + 1;
  const std::int32_t ahead = std::min(length, cells[0] - box.low[0]);
  CellCounts at;
  at[2] = box.low[2];
  for (std::int32_t z = 0; z <= box.more[2]; ++z) {
    at[1] = box.low[1];
    for (std::int32_t y = 0; y <= box.more[1]; ++y) {
      const auto row = static_cast<std::uint32_t>((at[2] * cells[1] + at[1]) * cells[0]);
      const std::uint32_t first = row + static_cast<std::uint32_t>(box.low[0]);
      if (visit(first, first + static_cast<std::uint32_t>(ahead))) return true;
      if (ahead < length && visit(row, row + static_cast<std::uint32_t>(length - ahead))) {
        return true;
      }
      if (++at[1] == cells[1]) at[1] = 0;
    }
    if (++at[2] == cells[2]) at[2] = 0;
  }
  return false;
}

/// Whether visit(index) returns true for any cell of the box. Stops at the first one for which it
/// does.
template <class Visit>
bool any_in(const CellBox& box, const CellCounts& cells, Visit&& visit) {
  return any_row_in(box, cells, [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t cell = first; cell < end; ++cell) {
      if (visit(cell)) return true;
    }
    return false;
  });
}

/// Number of cells along each axis that covers a distance [L] from any point of a cell.
inline CellCounts cells_within(const CellGrid& grid, double distance) {
  CellCounts out;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::floor(distance / grid.sides()[axis]) + 1;
    out[axis] = static_cast<std::int32_t>(std::min<double>(cells, grid.counts()[axis]));
  }
  return out;
}

/// The smallest box that holds all cells within `distance` [L] of r along each axis, and the cell
/// `one` if given. That cell must be one of these or adjacent to them, without wrapping relative
/// to r.
inline CellBox cells_around(const CellGrid& grid, const Vec3d& r, double distance,
                            std::optional<Cell> one = {}) {
  const Vec3d all_around{distance, distance, distance};
  Cell low = grid.cell_of(r - all_around), high = grid.cell_of(r + all_around);
  CellBox out;
  for (int axis = 0; axis < 3; ++axis) {
    if (one) {
      low[axis] = std::min(low[axis], (*one)[axis]);
      high[axis] = std::max(high[axis], (*one)[axis]);
    }
    out.low[axis] = grid.wrap(low[axis], axis);
    out.more[axis] = std::min(high[axis] - low[axis], grid.counts()[axis] - 1);
  }
  return out;
}

/// All cells closer than some distance to a given cell, approximately a ball, or to a position.
class CellBall {
 public:
  CellBall(const CellGrid& grid, double distance)
      : cells_(grid.counts()),
        squared_sides_(grid.sides()),
        distance_(distance),
        extent_(cells_within(grid, distance)) {
    for (double& side : squared_sides_) side *= side;
    for (std::int32_t z = -extent_[2]; z <= extent_[2]; ++z) {
      for (std::int32_t y = -extent_[1]; y <= extent_[1]; ++y) {
        std::int32_t x = -1;
        while (x < extent_[0] && comes_near({x + 1, y, z})) ++x;
        if (x >= 0) rows_.push_back({{-x, y, z}, std::min(2 * x, cells_[0] - 1)});
      }
    }
  }

  /// Largest distance of a cell of the ball from the centre along each axis, in cells.
  const CellCounts& extent() const { return extent_; }

  /// Whether a cell is closer than the distance to a position, which is given as
  /// CellGrid::in_sides.
  bool comes_near(const Vec3d& position, const CellCounts& cell) const {
    double squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double ahead = std::abs(component(position, axis) - (cell[axis] + 0.5));
      const double gap = std::max(0.0, std::min(ahead, cells_[axis] - ahead) - 0.5);
      squares += gap * gap * squared_sides_[axis];
    }
    return squares < distance_ * distance_;
  }

  /// Whether visit(first, end) returns true for any row of cells of the ball around `centre`; see
  /// any_row_in.
  template <class Visit>
  bool any_row(const CellCounts& centre, Visit&& visit) const {
    for (const Row& row : rows_) {
      CellBox box{centre, {row.more, 0, 0}};
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = wrapped(centre[axis] + row.first[axis], cells_[axis]);
      }
      if (any_row_in(box, cells_, visit)) return true;
    }
    return false;
  }

 private:
  // Adjacent cells along x. `first` is the offset of the first one from the centre.
  struct Row {
    CellCounts first;
    std::int32_t more;
  };

  // Whether two cells that are `steps` apart along the axes are closer than the distance.
  bool comes_near(const CellCounts& steps) const {
    double squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double gap = std::max(0, std::abs(steps[axis]) - 1);
      squares += gap * gap * squared_sides_[axis];
    }
    return squares < distance_ * distance_;
  }
  static std::int32_t wrapped(std::int32_t cell, std::int32_t count) {
    return cell < 0 ? cell + count : cell >= count ? cell - count : cell;
  }

  CellCounts cells_;
  std::array<double, 3> squared_sides_;  ///< of cells [L^2]
  double distance_;
  CellCounts extent_;
  std::vector<Row> rows_;
};

}  // namespace needlework
