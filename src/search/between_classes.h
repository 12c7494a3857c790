// How a needle of one size class looks for those of another, which have cells, and maybe a kind of
// bounding volume, of their own.
//
// Why no pair is left out: the seeker is moved into the frame of the other class's cells, with a
// margin for what that rounds. The axis of its capsule, or the path of its centre, is a segment;
// two in contact have segments no farther apart than the sum of how far their axes may be from them
// (Look::distance), whichever kinds theirs are. Where there is gravity, paths are taken for the
// straight ones of the falling frame, with room for how far they bend in the time ahead.
#pragma once

#include <cmath>

#include "src/search/bounding_volumes.h"
#include "src/search/look.h"
#include "src/search/volumes.h"

namespace needlework {

/// Looks from a cell of the other class at what `look` looks at from one of its own class.
template <class Own>
inline void see_from_class(const ClassCells& own, const MotionFrame& frame, Look& look) {
  const ClassCells& there = *look.cells;
  kernels::Seeker& seeker = look.seeker;
  const float* const r = Own::centre(seeker);
  const double unit = 1 / frame.per_length;
  const Vec3d corner = own.grid.corner(look.origin);
  look.origin = there.grid.cell_of(corner + Vec3d{r[0] * unit, r[1] * unit, r[2] * unit});
  const Vec3d shift = (corner - there.grid.corner(look.origin)) * frame.per_length;
  for (int axis = 0; axis < 3; ++axis) {
    const double by = component(shift, axis);
    seeker.motion.r[axis] = static_cast<float>(seeker.motion.r[axis] + by);
    seeker.r[axis] = static_cast<float>(seeker.r[axis] + by);
  }
  // The rounding of the seeker's place, in its own cell and in this one.
  seeker.margin = own.margin + there.margin + Own::rounding(own);
}

/// How far the straight path of a needle, or of one that it looks for, may be from the true one, as
/// long as both stay in their bounding volumes. [unit of length]
inline float bend(const BoundingVolumes& volumes, const ClassCells& own,
                  const kernels::Seeker& seeker) {
  if (!volumes.frame.falls) return 0;
  // Neither path leaves the cell that contains all bounding volumes of the class.
  const auto sides = volumes.grid.sides();
  const double widest = 2 * (sides[0] + sides[1] + sides[2] + 3 * volumes.drift) + own.most_fallen;
  return volumes.frame.bend(seeker, widest);
}
/// Both are at rest.
inline float bend_between(InCapsules, InCapsules, const BoundingVolumes&, const ClassCells&,
                          const kernels::Seeker&) {
  return 0;
}
template <class Own, class There>
inline float bend_between(Own, There, const BoundingVolumes& volumes, const ClassCells& own,
                          const kernels::Seeker& seeker) {
  return bend(volumes, own, seeker);
}

/// Compares a seeker with those of another class in the cells around.
inline kernels::Scan scan_between(InCells, InCells, const kernels::NearKernels& kernels,
                                  const kernels::Surroundings& around, Look& look,
                                  const kernels::Found& found) {
  return kernels.approaching(around, look.seeker, found);
}
inline kernels::Scan scan_between(InCapsules, InCells, const kernels::NearKernels& kernels,
                                  const kernels::Surroundings& around, Look& look,
                                  const kernels::Found& found) {
  look.seeker.axis_half = look.seeker.motion.half;
  return kernels.near_paths(around, look.seeker, look.distance, found);
}
inline kernels::Scan scan_between(InCapsules, InCapsules, const kernels::NearKernels& kernels,
                                  const kernels::Surroundings& around, Look& look,
                                  const kernels::Found& found) {
  look.seeker.axis_half = look.seeker.motion.half;
  return kernels.near_capsules(around, look.seeker, look.distance, found);
}
inline kernels::Scan scan_between(InCells, InCapsules, const kernels::NearKernels& kernels,
                                  const kernels::Surroundings& around, Look& look,
                                  const kernels::Found& found) {
  // The path is the segment.
  kernels::Seeker& seeker = look.seeker;
  const Vec3d way{look.high[0] - look.low[0], look.high[1] - look.low[1],
                  look.high[2] - look.low[2]};
  const double length = std::sqrt(dot(way, way));
  const double per_way = length > 0 ? 1 / length : 0;
  for (int axis = 0; axis < 3; ++axis) {
    seeker.r[axis] = 0.5f * (look.low[axis] + look.high[axis]);
    const double share = component(way, axis) * per_way;
    seeker.u[axis] = static_cast<float>(seeker.motion.v[axis] < 0 ? -share : share);
  }
  seeker.axis_half = static_cast<float>(0.5 * length);
  return kernels.near_capsules(around, look.seeker, look.distance, found);
}

}  // namespace needlework
