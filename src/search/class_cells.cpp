#include "src/search/class_cells.h"

#include <algorithm>

#include "src/search/volumes.h"

namespace needlework {

ClassCells::ClassCells(const MotionFrame& frame, const SizeClass& sizes, const CellGrid& its_grid)
    : kind(sizes.kind),
      radius(sizes.capsule_radius),
      in_capsules(static_cast<float>(radius * frame.per_length)),
      longest_half(static_cast<float>(0.5 * sizes.axis * frame.per_length)),
      widest_half(static_cast<float>(0.5 * sizes.diameter * frame.per_length)),
      grid(its_grid),
      overlap(with_volume(kind, [&](auto volume) { return volume.overlap_of(its_grid); })),
      ahead(overlap * with_volume(kind, [](auto volume) { return volume.ahead; })),
      cells(grid.size(), sizes.count, frame.gas.has_own_bodies()) {
  const auto sides = grid.sides();
  const double side = std::max({sides[0], sides[1], sides[2]});
  most_fallen = frame.most_fallen(side, sizes.longest);
  const double low = -overlap - most_fallen, widest = side + overlap + most_fallen;
  format = kernels::WordFormat::holding(low * frame.per_length, widest * frame.per_length);
  margin = kernels::margin_of_lengths(widest * frame.per_length);
  if (frame.gas.shear) rows.emplace(frame.gas, grid);
}

}  // namespace needlework
