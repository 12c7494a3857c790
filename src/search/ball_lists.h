// Spheres in balls: capsules that spheres, which do not leave them by turning, keep through
// collisions, and lists of those whose balls overlap.
//
// Why no pair is left out: a sphere searches again before it leaves its ball, so two can be in
// contact only if their balls, widened by half their diameters, overlap. Whichever got its ball
// later found the other one by a scan of the cells as a capsule would (in_capsules.h), and both
// have been in each other's lists since: lists change with balls alone. Needles would leave theirs
// too soon (bench/experiments.md).
#pragma once

#include <vector>

#include "src/memory/large_array.h"
#include "src/search/bounding_volumes.h"
#include "src/search/cell_scan.h"
#include "src/search/found_columns.h"
#include "src/search/neighbour_lists.h"
#include "src/search/pair_table.h"

namespace needlework {

/// Lists are those of one thread. Finds spheres as CellScan does, but in lists: the view of a
/// neighbour is its number there.
class BallLists {
 public:
  /// Whether the class of all bodies, if it is one, is to be in balls, and lists can hold by how
  /// many cells two that overlap are apart.
  static bool suit(const BoundingVolumes& volumes);
  /// `volumes` must outlive the lists.
  explicit BallLists(BoundingVolumes& volumes);

  /// Enters sphere i where it is now; if it has got another ball, finds its neighbours by the scan.
  /// Returns whether it has come from another cell.
  bool place(Needle i, Time now, CellScan& scan);
  /// All spheres get other balls when they are placed next.
  void begin_again();
  /// Sphere i has become sphere ranks[i].
  void renumber(const std::vector<Needle>& ranks);
  void prefetch(Needle i) const {
    needlework::prefetch(&balls_[i]);
    lists_.prefetch(i);
  }

  // As of CellScan.

  kernels::Scan look(Needle i, double ahead);
  kernels::Found found() { return found_.from(0); }
  auto offsets() const {
    return [four = lists_.by_fours(Needle(seeker_.needle)), &sides = sides_](std::size_t k,
                                                                             std::size_t) {
      return FourOffsets{four(k).cells_along(0) * sides[0], four(k).cells_along(1) * sides[1],
                         four(k).cells_along(2) * sides[2]};
    };
  }
  Cell cell_seen(std::uint32_t view) const {
    const Needle i(seeker_.needle);
    Cell out = volumes_.places[i].cell;
    for (int axis = 0; axis < 3; ++axis) out[axis] += lists_.of(i)[view].cells[axis];
    return out;
  }
  const kernels::Seeker& seeker() const { return seeker_; }
  template <class Visit>
  void for_each_seeker(Visit&& visit) const {
    visit(seeker_, std::size_t{0}, count_);
  }

 private:
  // Where a sphere has got its ball.
  struct Ball {
    Vec3d centre;  ///< in the frame of a record that has been wrapped by `image` [L]
    Shift image;
  };

  void follow_wraps(Needle i, const Shift& image, Time now);
  void list_neighbours(Needle i, CellScan& scan);

  BoundingVolumes& volumes_;
  LargeArray<Ball> balls_;
  NeighbourLists lists_;
  std::vector<NeighbourLists::Neighbour> neighbours_;  ///< of one sphere
  kernels::Seeker seeker_{};
  std::size_t count_ = 0;
  float sides_[3] = {};  ///< of cells [unit of length]
  FoundColumns found_;
};

}  // namespace needlework
