// The box cut into equal cells, for searches that look for neighbours cell by cell.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/vec3.h"

namespace needlework {

/// Cell of a centre in the frame of the needle's record: not wrapped into the box.
using Cell = std::array<std::int32_t, 3>;

/// How the sides of cells, of which a whole number fits, compare with what is asked for.
enum class CellFit { at_least, nearest };

class CellGrid {
 public:
  CellGrid() = default;
  /// As many cells as fit with such sides, one at least, but not many more than
  /// `most_per_needle`: empty ones would cost memory and crossings, up to all the memory there is.
  /// Then up to a quarter more along an axis, with shorter sides, where that gives a multiple of
  /// what is asked for there.
  CellGrid(const std::array<double, 3>& box, double side, std::size_t needles,
           const std::array<std::int32_t, 3>& multiples = {1, 1, 1}, double most_per_needle = 16,
           CellFit fit = CellFit::at_least) {
    const double most =
        std::min(0x1p12 + most_per_needle * static_cast<double>(needles), 0x1p31 - 1);
    const auto fitting = [&](int axis) {
      const double cells = box[axis] / side;
      return std::max(1.0, std::floor(fit == CellFit::nearest ? cells + 0.5 : cells));
    };
    while (fitting(0) * fitting(1) * fitting(2) > most) side *= 1.25;
    for (int axis = 0; axis < 3; ++axis) {
      const auto count = static_cast<std::int32_t>(fitting(axis));
      const std::int32_t more = (multiples[axis] - count % multiples[axis]) % multiples[axis];
      count_[axis] = more <= count / 4 ? count + more : count;
      side_[axis] = box[axis] / count_[axis];
      reciprocal_[axis] = 1 / side_[axis];
    }
  }

  std::array<std::int32_t, 3> counts() const { return count_; }
  std::array<double, 3> sides() const { return side_; }
  std::size_t size() const {
    return static_cast<std::size_t>(count_[0]) * count_[1] * static_cast<std::size_t>(count_[2]);
  }

  /// The cell of a centre; one next to its border may fall on either side.
  Cell cell_of(const Vec3d& r) const {
    return {floor(r.x * reciprocal_[0]), floor(r.y * reciprocal_[1]), floor(r.z * reciprocal_[2])};
  }
  Vec3d corner(const Cell& cell) const {
    return {cell[0] * side_[0], cell[1] * side_[1], cell[2] * side_[2]};
  }

  std::int32_t wrap(std::int32_t c, int axis) const {
    const std::int32_t n = count_[axis];
    // A division is slow.
    if (0 <= c && c < n) return c;
    if (-n <= c && c < 0) return c + n;
    const std::int32_t m = c % n;
    return m < 0 ? m + n : m;
  }
  std::size_t index(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x;
  }
  std::size_t index_of(const Cell& cell) const {
    return index(wrap(cell[0], 0), wrap(cell[1], 1), wrap(cell[2], 2));
  }

  /// Calls visit(cell, index) for the cell and all around it, by rows along x; images of one cell
  /// are visited apart where there are fewer than three.
  template <class Visit>
  void for_each_around(const Cell& centre, Visit&& visit) const {
    for (std::int32_t z = centre[2] - 1; z <= centre[2] + 1; ++z) {
      const std::int32_t wz = wrap(z, 2);
      for (std::int32_t y = centre[1] - 1; y <= centre[1] + 1; ++y) {
        const std::int32_t wy = wrap(y, 1);
        for (std::int32_t x = centre[0] - 1; x <= centre[0] + 1; ++x) {
          visit(Cell{x, y, z}, index(wrap(x, 0), wy, wz));
        }
      }
    }
  }

  /// Cells of one axis that are near an interval.
  struct AxisCell {
    std::int32_t cell;  ///< not wrapped
    std::int32_t wrapped;
    float offset;       ///< of its corner from that of the cell `origin` [unit]
    float gap_squared;  ///< of its distance from the interval, not above [unit^2]
  };

  /// Appends the cells of an axis that, extended by `overlap` on either side, are at most `reach`
  /// away from [low, high]. They are described in a unit of length of which L contains
  /// `per_length`, a power of two.
  void append_near(int axis, std::int32_t origin, double low, double high, double overlap,
                   double reach, double per_length, std::vector<AxisCell>& out) const {
    low -= overlap;
    high += overlap;
    const std::int32_t first = floor((low - reach) * reciprocal_[axis]);
    const std::int32_t last = floor((high + reach) * reciprocal_[axis]);
    std::int32_t wrapped = wrap(first, axis);
    for (std::int32_t c = first; c <= last; ++c) {
      const double gap =
          std::max({0.0, c * side_[axis] - high, low - (c + 1) * side_[axis]}) * per_length;
      out.push_back({c, wrapped, static_cast<float>((c - origin) * side_[axis] * per_length),
                     static_cast<float>(gap * gap * (1 - 0x1p-20))});
      if (++wrapped == count_[axis]) wrapped = 0;
    }
  }

  /// Number of boxes to add to a centre in cell `from` to move it to `to`, an image of that cell.
  std::array<std::int32_t, 3> boxes_between(const Cell& to, const Cell& from) const {
    if (to[0] == from[0] && to[1] == from[1] && to[2] == from[2]) return {};
    return {(to[0] - from[0]) / count_[0], (to[1] - from[1]) / count_[1],
            (to[2] - from[2]) / count_[2]};
  }

  /// Time until a centre at r with velocity v is out of the cell by `margin` [L]. Then it is in
  /// another cell, whatever rounding does to it.
  double time_to_leave(const Cell& cell, const Vec3d& r, const Vec3d& v, double margin) const {
    const double position[3] = {r.x, r.y, r.z}, velocity[3] = {v.x, v.y, v.z};
    double out = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double low = cell[axis] * side_[axis];
      if (velocity[axis] > 0) {
        out = std::min(out, (low + side_[axis] + margin - position[axis]) / velocity[axis]);
      } else if (velocity[axis] < 0) {
        out = std::min(out, (low - margin - position[axis]) / velocity[axis]);
      }
    }
    return std::max(out, 0.0);
  }

 private:
  // std::floor is a call, or a dozen instructions, where processors need not have SSE4.
  static std::int32_t floor(double x) {
    const auto towards_zero = static_cast<std::int32_t>(x);
    return towards_zero - (x < towards_zero);
  }

  std::array<std::int32_t, 3> count_{};
  std::array<double, 3> side_{}, reciprocal_{};
};

}  // namespace needlework
