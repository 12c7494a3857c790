// The cells of one size class, and the needles in them.
#pragma once

#include <optional>

#include "src/search/cell_grid.h"
#include "src/search/motion_frame.h"
#include "src/search/needle_cells.h"
#include "src/search/setup.h"
#include "src/search/size_classes.h"
#include "src/search/sliding_rows.h"

namespace needlework {

struct ClassCells {
  ClassCells(const MotionFrame& frame, const SizeClass& sizes, const CellGrid& its_grid);

  BoundingVolume kind;
  double radius;       ///< of capsules around axes, in which needles move; else 0 [L]
  float in_capsules;   ///< the same [unit of length]
  float longest_half;  ///< half the longest axis [unit of length]
  float widest_half;   ///< half the largest diameter [unit of length]
  CellGrid grid;
  double overlap;              ///< how far a needle may go beyond its cell; 0 for capsules [L]
  double ahead;                ///< the same when it is placed [L]
  double most_fallen;          ///< by the frame of motions since its base, at most [L]
  kernels::WordFormat format;  ///< of the words in blocks
  float margin;                ///< of lengths, see kernels::Seeker [unit of length]
  NeedleCells cells;
  std::optional<SlidingRows> rows;  ///< if cells slide in rows
};

}  // namespace needlework
