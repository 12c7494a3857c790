// The box cut into equal cells, for searches that look for neighbours cell by cell.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/four.h"
#include "kernels/vec3.h"
#include "src/box/box.h"
#include "src/physics/motion.h"

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

  /// So many cells along the edges of the box.
  static CellGrid of_counts(const std::array<double, 3>& box,
                            const std::array<std::int32_t, 3>& counts) {
    CellGrid out;
    for (int axis = 0; axis < 3; ++axis) {
      out.count_[axis] = counts[axis];
      out.side_[axis] = box[axis] / counts[axis];
      out.reciprocal_[axis] = 1 / out.side_[axis];
    }
    return out;
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
  /// A centre wrapped into the box, in sides of cells. [side]
  Vec3d in_sides(const Vec3d& r) const {
    const Vec3d at{r.x * reciprocal_[0], r.y * reciprocal_[1], r.z * reciprocal_[2]};
    const auto wrapped = [&](double x, int axis) {
      const std::int32_t cell = floor(x);
      return x - cell + wrap(cell, axis);
    };
    return {wrapped(at.x, 0), wrapped(at.y, 1), wrapped(at.z, 2)};
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
    float gap_squared;  ///< of its distance from the interval [unit^2]
  };

  /// Finds the cells of an axis that are at most `reach` away from the interval from `low` to
  /// `high`, and stores them at the beginning of `out`; returns how many. Lengths count from the
  /// corner of the cell `origin`, in a unit of which L contains `per_length`. Distances are off by
  /// up to 2^-21 of the largest length, either way, for which `reach` must have room. [unit]
  std::size_t find_near(int axis, std::int32_t origin, float low, float high, float reach,
                        double per_length, std::vector<AxisCell>& out) const {
    using kernels::four, kernels::Four, kernels::FourInts;
    static_assert(sizeof(AxisCell) == sizeof(Four));
    const auto side = static_cast<float>(side_[axis] * per_length);
    const auto reciprocal = static_cast<float>(reciprocal_[axis] / per_length);
    const std::int32_t first = floor((low - reach) * reciprocal);
    const auto count = static_cast<std::size_t>(floor((high + reach) * reciprocal) - first + 1);
    if (out.size() < count + 4) out.resize(count + 4);
    const std::int32_t n = count_[axis];
    FourInts after = FourInts{0, 1, 2, 3} + first;
    FourInts wrapped = FourInts{0, 1, 2, 3} + wrap(origin + first, axis);
    for (std::size_t k = 0; k < count; k += 4, after += 4, wrapped += 4) {
      // From less than n + 4 to less than n, even if n is 1.
      for (int times = 0; times < 4; ++times) wrapped -= wrapped >= n ? FourInts{} + n : FourInts{};
      const Four offset = __builtin_convertvector(after, Four) * four(side);
      const Four below = offset - four(high), above = four(low) - (offset + four(side));
      const Four gap = kernels::larger(kernels::larger(below, above), four(0));
      Four rows[4] = {reinterpret_cast<Four>(after + origin), reinterpret_cast<Four>(wrapped),
                      offset, gap * gap};
      kernels::transpose(rows);
      for (int i = 0; i < 4; ++i) kernels::store_four(rows[i], &out[k + i]);
    }
    return count;
  }

  /// Number of boxes to add to a centre in cell `from` to move it to `to`, an image of that cell.
  Shift boxes_between(const Cell& to, const Cell& from) const {
    if (to[0] == from[0] && to[1] == from[1] && to[2] == from[2]) return {};
    return {(to[0] - from[0]) / count_[0], (to[1] - from[1]) / count_[1],
            (to[2] - from[2]) / count_[2]};
  }

  /// The cell that many boxes from a cell.
  Cell image_of(const Cell& cell, const Shift& boxes) const {
    return {cell[0] + boxes[0] * count_[0], cell[1] + boxes[1] * count_[1],
            cell[2] + boxes[2] * count_[2]};
  }
  /// The shortest way from an image of one centre to another, which are `in_sides` apart. [L]
  Vec3d shortest(const Vec3d& in_sides) const {
    const auto along = [&](double gap, int axis) {
      const double count = count_[axis];
      return (gap - std::nearbyint(gap / count) * count) * side_[axis];
    };
    return {along(in_sides.x, 0), along(in_sides.y, 1), along(in_sides.z, 2)};
  }

  /// Time until a centre that moves like this is out of the cell by `margin` [L]. Then it is in
  /// another cell, whatever rounding does to it.
  template <NeedleMotion M>
  double time_to_leave(const Cell& cell, const MotionFrom<M>& from, double margin) const {
    const Vec3d low = corner(cell), wide{margin, margin, margin};
    const Vec3d high = low + Vec3d{side_[0], side_[1], side_[2]};
    return from.motion.time_to_leave(from.start, low - wide, high + wide);
  }

 private:
  // std::floor is a call, or a dozen instructions, where processors need not have SSE4.
  template <class Number>
  static std::int32_t floor(Number x) {
    const auto towards_zero = static_cast<std::int32_t>(x);
    return towards_zero - (x < static_cast<Number>(towards_zero));
  }

  std::array<std::int32_t, 3> count_{};
  std::array<double, 3> side_{}, reciprocal_{};
};

}  // namespace needlework
