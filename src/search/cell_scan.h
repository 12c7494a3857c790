// The scan that all searches with SIMD share: through the cells around a needle, for those that it
// might meet before it searches again.
//
// Why no pair is left out: how far around the needle the entries of others may be is told by the
// kind of its bounding volume and of theirs (in_cells.h, in_capsules.h), or of those of another
// size class (between_classes.h). Views are made of all cells within that reach (cell_views.h), and
// every needle in these goes through the kernel of the two kinds. Each reach has room for what
// rounds it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "kernels/four.h"
#include "src/search/bounding_volumes.h"
#include "src/search/cell_views.h"
#include "src/search/found_columns.h"
#include "src/search/look.h"
#include "src/search/pair_table.h"

namespace needlework {

/// One thread's. Finds bodies with the cells in which they are seen.
class CellScan {
 public:
  /// `volumes` must outlive the scan.
  CellScan(const BoundingVolumes& volumes, const kernels::NearKernels& kernels)
      : volumes_(volumes), kernels_(kernels), looks_(volumes.classes.size()) {}

  /// Finds those whose bounding volumes are near that of needle i, or near its path in the time
  /// ahead. All below is of the last one.
  kernels::Scan look(Needle i, double ahead);

  /// With numbers of views.
  kernels::Found found() { return found_.from(0); }
  /// Where the cells are in which these are seen.
  auto offsets() const {
    return [views = views_.data(), cells = found_.cells()](std::size_t k, std::size_t end) {
      static_assert(offsetof(kernels::CellView, offset) == 4);
      kernels::Four row[4];
      for (std::size_t i = 0; i < 4; ++i) {
        row[i] = kernels::load_four(&views[cells[std::min(k + i, end - 1)]]);
      }
      kernels::transpose(row);
      return FourOffsets{row[1], row[2], row[3]};
    };
  }
  /// The cell in which a needle is seen, not wrapped into the box.
  const Cell& cell_seen(std::uint32_t view) const { return views_.cell(view); }
  /// Needle i; its place is that of its own class, and its margin enough for all.
  const kernels::Seeker& seeker() const { return looks_.front().seeker; }
  /// Calls visit(seeker, begin, end) for the stretches of needles found that one seeker sees.
  template <class Visit>
  void for_each_seeker(Visit&& visit) const {
    for (const Look& each : looks_) {
      visit(each.seeker, each.first_found, each.first_found + each.found);
    }
  }

 private:
  template <class Own>
  void set_first(const ClassCells& own, Needle i, double ahead, Look& first);
  template <class Own>
  kernels::Scan look_into_one_class(double ahead);
  template <class Own>
  kernels::Scan look_into_classes(Needle i, double ahead);
  template <class Own>
  kernels::Scan look_into_rows(Needle i, double ahead, Time now);
  friend class RowScan;
  template <class Scanned>
  kernels::Scan scan_all(const Scanned& scan);
  template <class Own, class There>
  void set_reach(const ClassCells& own, float bend, Look& look) const;
  kernels::Surroundings surroundings(const Look& look) const;

  const BoundingVolumes& volumes_;
  const kernels::NearKernels& kernels_;
  std::vector<Look> looks_;  ///< one for each class, the own one first
  CellViews views_;
  FoundColumns found_;
};

/// The same where cells slide in rows (sliding_rows.h).
class RowScan : public CellScan {
 public:
  using CellScan::CellScan;
  /// When look() will be called.
  void set_now(Time now) { now_ = now; }
  kernels::Scan look(Needle i, double ahead);
  /// The boxes to be added to the record of j, which i has found in this view, so many from that of
  /// j between their cells.
  Shift shift_in_rows(Needle i, Needle j, std::uint32_t view, const Shift& between_cells) const;

 private:
  Time now_;
};

/// Sets the seeker to needle i, as it flies now.
inline void set_seeker(const BoundingVolumes& volumes, const ClassCells& own, Needle i,
                       double ahead, kernels::Seeker& seeker) {
  constexpr double roundup = 1 + 0x1p-20;
  seeker.motion = volumes.motions[i];
  seeker.now = seeker.motion.time;
  seeker.ahead =
      static_cast<float>(ahead * volumes.frame.per_time * roundup + kernels::time_margin);
  seeker.margin = own.margin;
  seeker.needle = i.index;
}

}  // namespace needlework
