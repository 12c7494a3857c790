// Numbers of the cells of a grid that hold the centres of all needles, for counting or sorting
// them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "src/physics/gas.h"
#include "src/physics/vectors.h"

namespace needlework {

/// A cell by its places along the axes.
using BoxCell = std::array<std::uint64_t, 3>;

/// What `key` makes of the cell of each centre at `now`, wrapped into the box, which has `cells`
/// cells of equal sides along each axis (the last one may be a part of one). In the order of the
/// records; what `key` throws ends it.
template <class Key>
std::vector<std::uint64_t> keys_of_cells(const Gas& gas, Time now,
                                         const std::array<double, 3>& cells, Key key) {
  std::vector<std::uint64_t> keys;
  keys.reserve(gas.size());
  const Box box = gas.box_at(now);
  for (const Record& record : gas.records) {
    const Vec3d r = gas.motion_from(record, now).centre();
    const std::array<double, 3> share = box.share(to_array(r));
    BoxCell cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // A share just below a whole number is rounded up to it.
      const double last = std::ceil(cells[axis]) - 1;
      cell[axis] = static_cast<std::uint64_t>(std::min(share[axis] * cells[axis], last));
    }
    keys.push_back(key(cell));
  }
  return keys;
}

}  // namespace needlework
