// Finds which periodic images of two needles come within reach of each other, and when.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// The relative motion of two centres, r + v t. Doubles suffice here, because their rounding
/// errors are far smaller than the margin of the reach.
struct Approach {
  Vector<double> r, v;
  double bow = 0;  ///< by how much they may depart from that between the ends of the flight [L]
  /// Of the row of images above, along x: its place at time 0, and its velocity.
  double slide = 0, row_velocity = 0;

  /// To the images so many rows up.
  Approach to_row(int rows) const {
    Approach out = *this;
    out.r[0] -= rows * slide;
    out.v[0] -= rows * row_velocity;
    return out;
  }
};

/// r12 at time s for this image.
inline Vector<double> separation(const Approach& approach, double s, const Shift& shift,
                                 const std::array<double, 3>& box) {
  const Approach to_row = approach.to_row(shift[1]);
  Vector<double> r = to_row.r + to_row.v * s;
  for (int axis = 0; axis < 3; ++axis) r[axis] -= shift[axis] * box[axis];
  return r;
}

/// An image whose centre is within reach from time `begin` to `end`.
struct Encounter {
  Shift shift;
  double begin, end;
};

/// Needles can touch when their centres are within the mean of their extents; includes a margin for
/// rounding. [L]
inline double reach_of(const AuditedBody& first, const AuditedBody& second) {
  return first.extent() / 2 + second.extent() / 2 + 0x1p-20;
}

/// Calls `found` for each encounter in [0, duration], with images of the rows from `lowest` to
/// `highest` alone.
template <class Found>
void for_each_encounter_in_rows(const Approach& approach, double reach, double duration,
                                const Space& space, int lowest, int highest, Found&& found) {
  const std::array<double, 3>& box = space.box;
  const double flown = norm(approach.v) * duration;
  const double pieces = std::max(1.0, std::ceil(flown));
  std::vector<Shift> seen;  // images found in more than one piece of the flight
  for (double piece = 0; piece < pieces; ++piece) {
    // The images whose centres are near enough in the middle of the piece.
    const double near = reach + 0.5 * flown / pieces + 0x1p-20;
    const double middle = (piece + 0.5) / pieces * duration;
    int first[3], last[3];
    bool none = false;
    for (int axis = 0; axis < 3 && !none; ++axis) {
      const double r = approach.r[axis] + approach.v[axis] * middle;
      first[axis] = static_cast<int>(std::ceil((r - near) / box[axis]));
      last[axis] = static_cast<int>(std::floor((r + near) / box[axis]));
      if (!space.periodic[static_cast<std::size_t>(axis)]) {
        none = std::abs(r) > near;
        first[axis] = last[axis] = 0;
      }
      if (axis == 1) {
        first[axis] = std::max(first[axis], lowest);
        last[axis] = std::min(last[axis], highest);
      }
      none = none || first[axis] > last[axis];
    }
    if (none) continue;
    for (int x = first[0]; x <= last[0]; ++x) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int z = first[2]; z <= last[2]; ++z) {
          const Shift shift{x, y, z};
          const Vector<double> r = {
              {approach.r[0] - x * box[0], approach.r[1] - y * box[1], approach.r[2] - z * box[2]}};
          const double vv = dot(approach.v, approach.v);
          const double closest = vv > 0 ? -dot(r, approach.v) / vv : 0;
          const Vector<double> there = r + approach.v * closest;
          const double within = reach * reach - dot(there, there);
          if (within < 0) continue;
          const double half = vv > 0 ? std::sqrt(within / vv) : duration;
          const double begin = std::max(0.0, closest - half);
          const double end = std::min(duration, closest + half);
          if (begin > end) continue;
          if (pieces > 1) {
            if (std::find(seen.begin(), seen.end(), shift) != seen.end()) continue;
            seen.push_back(shift);
          }
          found(Encounter{shift, begin, end});
        }
      }
    }
  }
}

/// The same of all rows.
template <class Found>
void for_each_encounter(const Approach& approach, double reach, double duration, const Space& space,
                        Found&& found) {
  constexpr int most = std::numeric_limits<int>::max();
  if (!space.rows)
    return for_each_encounter_in_rows(approach, reach, duration, space, -most, most, found);
  const double way = approach.v[1] * duration, edge = space.box[1], near = reach + 0x1p-20;
  const double low = approach.r[1] + std::min(0.0, way) - near,
               high = approach.r[1] + std::max(0.0, way) + near;
  const int first = static_cast<int>(std::ceil(low / edge)),
            last = static_cast<int>(std::floor(high / edge));
  for (int row = first; row <= last; ++row) {
    for_each_encounter_in_rows(approach.to_row(row), reach, duration, space, row, row, found);
  }
}

}  // namespace needlework::audit
