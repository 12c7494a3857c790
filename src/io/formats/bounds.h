// The bounds of a box as other programs need them: LAMMPS refuses atoms beyond them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "needlework/state.h"

namespace needlework::io {

struct Bounds {
  std::array<double, 3> low{}, high{};  ///< [L]
  bool are_edges = true;                ///< whether the edges of the box follow from them

  /// Those of a cell with a tilt xy along x [L], as LAMMPS has them in dumps.
  void include(double tilt, const std::array<double, 3>& edges) {
    const double least = std::min(0.0, tilt), most = std::max(0.0, tilt);
    low[0] += least;
    high[0] += most;
    are_edges &= high[0] - most - (low[0] - least) == edges[0];  // but for a rounding
  }
};

/// The edges of the box and, along an axis that is not periodic, where centres are beyond them as
/// above an open side or behind a wall that has moved outwards, the farthest of these centres and
/// so much more. [L]
inline Bounds bounds_of(const State& state, double reach) {
  Bounds out{.high = state.box};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (state.periodic[axis]) continue;
    double least = 0, most = state.box[axis];
    for (const auto& r : state.position) {
      least = std::min(least, r[axis]);
      most = std::max(most, r[axis]);
    }
    if (least < 0) out.low[axis] = least - reach;
    if (most > state.box[axis]) out.high[axis] = most + reach;
    out.are_edges &= least == 0 && most == state.box[axis];
  }
  return out;
}

}  // namespace needlework::io
