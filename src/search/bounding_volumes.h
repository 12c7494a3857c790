// Where all needles are: the bounding volume of each, and the cells that hold them.
//
// A needle that is placed gets a bounding volume, a region fixed in space that it does not leave
// before a known time, and an entry in the cell that its centre is in. There are two kinds of
// regions and entries: in_cells.h, in_capsules.h.
//
// Why no pair is left out: only needles whose bounding volumes are near each other can meet before
// one of them is placed again, and a needle that is placed again searches again. So nothing else is
// kept, but for spheres (ball_lists.h).
//
// Needles of each size class (size_classes.h) have bounding volumes, and cells, of their own. The
// cells of all classes are parts of the cells of one common grid, by which threads divide the box.
// Where cells slide in rows along x, each cell of the common grid holds whole rows.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/near_needles.h"
#include "src/memory/large_array.h"
#include "src/physics/gas.h"
#include "src/search/cell_grid.h"
#include "src/search/class_cells.h"
#include "src/search/contact_distances.h"
#include "src/search/look.h"
#include "src/search/motion_frame.h"
#include "src/search/needle_cells.h"
#include "src/search/setup.h"
#include "src/search/size_classes.h"

namespace needlework {

/// Several threads may use it at once, as long as none reads what another writes: placing a needle
/// writes to the cells that it leaves and enters, finding its neighbours reads cells within
/// `Phase::neighbours` of its own (src/engine/phase.h).
struct BoundingVolumes {
  struct Place {
    Cell cell{};
    NeedleCells::Slot slot;
    /// When the needle will search again: the time of its next event or, from when it is placed
    /// until it has searched, the end of its time in its bounding volume.
    Time next_event = Time::never();

    bool is_entered() const { return slot.block != kernels::NeedleBlock::none; }
  };

  BoundingVolumes(const Gas& gas, const SearchSetup& setup, BoundingVolume kind);

  /// Enters needle i, of this half length [L], where it is now. Returns whether it has come from
  /// another cell.
  bool place(Needle i, Time now, double half_length);
  /// Needle i, which has been placed, will search again at this time. [time]
  void set_next_event(Needle i, Time time) {
    places[i].next_event = time;
    motions[i].until = frame.rounded_up(time);
  }
  /// Chooses the units of time again, as all needles will be placed now.
  void begin_again(Time now);
  /// Makes times from now on fit for place(), if they will soon not be. The threads share the work.
  void prepare(Time now, int threads);
  void renumber(const std::vector<Needle>& ranks);

  ClassCells& class_of(Needle i) const {
    if (classes.size() == 1) return *classes.front();
    return *classes[class_of_extent(sizes, 2 * gas.reach(i))];
  }
  /// The cell of the common grid in which needle i has been placed, in the frame of its record.
  Cell common_cell_of(Needle i) const { return is_of_one_grid_ ? places[i].cell : cell_around(i); }

  // What place() is made of, for other ways to place bodies.

  /// Makes times in words and motions fit for what is placed now.
  void make_fit(Time now) {
    if (!frame.holds(now)) rebase(now, 1);
  }
  /// Moves the entry of needle i to this cell. Returns whether it was in another one.
  bool enter(ClassCells& own, Needle i, const Cell& cell);
  /// Writes the entry, with velocity or director, in the units of motions.
  template <class Volume>
  void write_entry(ClassCells& own, Needle i, const Vec3d& centre, const Vec3d& direction,
                   Time now);
  /// All but the half length, which does not depend on the units of time. `elapsed` is the time
  /// since the needle's record. Motions of spheres have no directors.
  void set_motion(Needle i, double elapsed, const MotionFrame::Path& path, Time now);

  const Gas& gas;
  MotionFrame frame;
  ContactDistances distances;
  std::vector<std::unique_ptr<ClassCells>> classes;  ///< at least one
  std::vector<SizeClass> sizes;                      ///< of the same
  CellGrid grid;      ///< the common grid: of one class that does not slide, its own
  double radius = 0;  ///< how far from where a needle is it may be placed, at most [L]
  double drift = 0;   ///< how far from its cell a needle may come, at most [L]
  LargeArray<Place> places;
  LargeArray<kernels::Motion> motions;
  LargeArray<Shift> wraps;  ///< if cells slide in rows: boxes subtracted from a record's centre
  bool are_spheres;         ///< all bodies, so that no filter reads how they turn

 private:
  void carry_rows(Time now);
  Cell cell_around(Needle i) const;
  void begin_frame(Time now);
  void rebase(Time now, int threads);
  template <bool falls>
  bool place_one(Needle i, Time now, double half_length);
  bool place_in_row(Needle i, Time now, double half_length);
  template <class Volume, bool falls>
  bool place_in_row_as(Needle i, Time now, double half_length);
  template <bool falls>
  PresentNeedle present_needle(const kernels::Flight& flight, double elapsed, Time now,
                               double half_length) const;
  template <class Volume>
  bool enter_placed(ClassCells& own, Needle i, const PresentNeedle& needle, const Placement& placed,
                    Time now);

  bool moves_plainly_ = true;   ///< without gravity, in cells at rest
  bool is_of_one_grid_ = true;  ///< places are in cells of the common grid
};

template <class Volume>
inline void BoundingVolumes::write_entry(ClassCells& own, Needle i, const Vec3d& centre,
                                         const Vec3d& direction, Time now) {
  const Place& place = places[i];
  kernels::NeedleBlock& block = own.cells[place.slot.block];
  const Vec3d r = (centre - own.grid.corner(place.cell)) * frame.per_length;
  for (int axis = 0; axis < 3; ++axis) {
    block.word[axis][place.slot.lane] =
        Volume::word(own.format, component(r, axis), component(direction, axis));
  }
  if constexpr (Volume::timed) {
    block.time[place.slot.lane] = static_cast<float>(frame.since_base(now));
  }
}

}  // namespace needlework
