// Cells around a place: boxes of cells, and all that come near to one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/engine/zones.h"
#include "src/search/cell_grid.h"

namespace needlework {

/// A box of cells on a grid that repeats itself.
struct CellBox {
  CellCounts low{};   ///< in the grid
  CellCounts more{};  ///< cells beyond `low` along each axis, fewer than the grid has
};

/// Whether two boxes are not more than `distance` cells apart along every axis.
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

/// Whether visit(index) holds for any cell of the box; asks no more of them once it does.
template <class Visit>
bool any_in(const CellBox& box, const CellCounts& cells, Visit&& visit) {
  CellCounts at;
  at[2] = box.low[2];
  for (std::int32_t z = 0; z <= box.more[2]; ++z) {
    at[1] = box.low[1];
    for (std::int32_t y = 0; y <= box.more[1]; ++y) {
      const std::size_t row = (static_cast<std::size_t>(at[2]) * cells[1] + at[1]) * cells[0];
      at[0] = box.low[0];
      for (std::int32_t x = 0; x <= box.more[0]; ++x) {
        if (visit(static_cast<std::uint32_t>(row + at[0]))) return true;
        if (++at[0] == cells[0]) at[0] = 0;
      }
      if (++at[1] == cells[1]) at[1] = 0;
    }
    if (++at[2] == cells[2]) at[2] = 0;
  }
  return false;
}

/// Cells along each axis that cover a distance [L] from anywhere in a cell.
inline CellCounts cells_within(const CellGrid& grid, double distance) {
  CellCounts out;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::floor(distance / grid.sides()[axis]) + 1;
    out[axis] = static_cast<std::int32_t>(std::min<double>(cells, grid.counts()[axis]));
  }
  return out;
}

/// The cells not farther than `distance` [L] from r along the axes, and, if asked for, one more,
/// which is next to these or among them in the frame of r.
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

/// The cells that come nearer to a cell than some distance: about a ball of them.
class CellBall {
 public:
  CellBall(const CellGrid& grid, double distance)
      : cells_(grid.counts()), reach_(cells_within(grid, distance)) {
    const auto gap = [&](std::int32_t cells, int axis) {
      return std::max(0, std::abs(cells) - 1) * grid.sides()[axis];
    };
    for (std::int32_t z = -reach_[2]; z <= reach_[2]; ++z) {
      for (std::int32_t y = -reach_[1]; y <= reach_[1]; ++y) {
        std::int32_t x = -1;
        while (x < reach_[0] && std::hypot(gap(x + 1, 0), gap(y, 1), gap(z, 2)) < distance) ++x;
        if (x >= 0) rows_.push_back({{-x, y, z}, std::min(2 * x, cells_[0] - 1)});
      }
    }
  }

  /// None is farther along an axis.
  const CellCounts& reach() const { return reach_; }

  /// Whether visit(index) holds for any cell of the ball around this one.
  template <class Visit>
  bool any(const CellCounts& centre, Visit&& visit) const {
    for (const Row& row : rows_) {
      CellBox box{centre, {row.more, 0, 0}};
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = wrapped(centre[axis] + row.first[axis], cells_[axis]);
      }
      if (any_in(box, cells_, visit)) return true;
    }
    return false;
  }

 private:
  // Cells side by side, from one at `first` from the centre on.
  struct Row {
    CellCounts first;
    std::int32_t more;
  };

  static std::int32_t wrapped(std::int32_t cell, std::int32_t count) {
    return cell < 0 ? cell + count : cell >= count ? cell - count : cell;
  }

  CellCounts cells_, reach_;
  std::vector<Row> rows_;
};

}  // namespace needlework
