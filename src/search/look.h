// What all bounding volumes have in common: where a needle is placed in one, and how far around it
// a search looks for others.
#pragma once

#include <cstddef>

#include "kernels/near_needles.h"
#include "src/physics/gas.h"
#include "src/search/class_cells.h"

namespace needlework {

/// A needle that is to be placed, here and now.
struct PresentNeedle {
  MotionFrom<FreeFlight> motion;
  Vec3d centre;
  MotionFrame::Path path;  ///< in the frame of motions
  double half_length;      ///< [L]
};

/// What its entry in a cell says, and for how long.
struct Placement {
  Cell cell;
  Vec3d centre, direction;  ///< director, or velocity in the units of motions
  double stay;              ///< in its bounding volume from now on [time]
};

/// A needle that searches, as it looks into the cells of one size class: for all needles that may
/// be in a bounding volume near its own. Lengths count from the corner of `origin`, a cell of that
/// class, in the unit of length of kernels.
struct Look {
  const ClassCells* cells;
  kernels::Seeker seeker;
  Cell origin;
  float touching;         ///< largest distance of axes in contact
  float low[3], high[3];  ///< the box around the segment that the needle's centre or axis sweeps
  float distance;         ///< of centres from that segment, or of axes, in contact or in overlap
  float reach;            ///< how far from the segment the entries of others may be
  std::int32_t boxes;     ///< where cells slide in rows: to be added to bodies in that of the look
  std::size_t first_view, views;
  std::size_t first_found, found;
};

}  // namespace needlework
