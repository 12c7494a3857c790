// Where all needles are: the bounding volume of each, and the cells that hold them.
//
// A needle that is placed gets a bounding volume, a region fixed in space that it does not leave
// before a known time, and an entry in the cell that its centre is in. Only needles whose bounding
// volumes are near each other can meet before one of them is placed again, and a needle that is
// placed again searches again. So nothing else is kept, but for spheres (neighbour_lists.h).
//
//   cell     the bounding volume is the cell and a fifth of its side around it
//   capsule  the bounding volume is a capsule of radius delta around the needle
//
// Needles of each size class (size_classes.h) have bounding volumes, and cells, of their own. The
// cells of all classes are parts of the cells of one common grid, by which threads divide the box.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/near_needles.h"
#include "src/memory/large_array.h"
#include "src/physics/gas.h"
#include "src/search/cell_grid.h"
#include "src/search/needle_cells.h"
#include "src/search/setup.h"
#include "src/search/size_classes.h"

namespace needlework {

/// The cells of one size class, and the needles in them.
struct ClassCells {
  ClassCells(const Gas& gas, const SizeClass& sizes, const CellGrid& its_grid, double per_length);

  BoundingVolume kind;
  double radius;       ///< of capsules around axes, in which needles move; else 0 [L]
  float in_capsules;   ///< the same [unit of length]
  float longest_half;  ///< half the longest axis [unit of length]
  float widest_half;   ///< half the largest diameter [unit of length]
  CellGrid grid;
  double overlap = 0;          ///< how far a needle may go beyond its cell; 0 for capsules [L]
  kernels::WordFormat format;  ///< of the words in blocks
  double most_fallen = 0;      ///< by the frame of motions since `base`, at most [L]
  float margin = 0;            ///< of lengths, see kernels::Seeker [unit of length]
  NeedleCells cells;
};

/// Several threads may use it at once, as long as none reads what another writes: placing a needle
/// writes to the cells that it leaves and enters, finding its neighbours reads cells within
/// `Phase::neighbours` of its own (src/engine/phase.h).
///
/// Blocks and motions are in units that are powers of two: lengths in units of
/// 1 / per_length, times in units of 1 / per_time and counted from `base`. Where there is gravity,
/// motions, and the words of cells, are those seen from a frame that falls with all needles and is
/// at rest at `base`: there they are straight, which is what kernels compute with. Cells and
/// capsules are at rest themselves.
struct BoundingVolumes {
  struct Place {
    Cell cell{};
    NeedleCells::Slot slot;
    /// When the needle will search again: the time of its next event or, from when it is placed
    /// until it has searched, the end of its time in its bounding volume.
    Time next_event = Time::never();

    bool is_entered() const { return slot.block != kernels::NeedleBlock::none; }
  };

  /// Where a sphere that stays in its bounding volume through collisions has got it.
  struct Ball {
    Vec3d centre;  ///< in the frame of a record that has been wrapped by `image` [L]
    Shift image;
  };

  BoundingVolumes(const Gas& gas, const SearchSetup& setup, BoundingVolume kind);

  /// Enters needle i, of this half length [L], where it is now. Returns whether it has come from
  /// another cell.
  bool place(Needle i, Time now, double half_length);
  /// The same for a sphere in a class with `in_balls`, which stays in its ball for as long as it
  /// can. `is_new` tells whether it has got another one.
  bool place_in_ball(Needle i, Time now, bool& is_new);
  /// All spheres get other balls when they are placed next.
  void leave_balls();
  /// Needle i, which has been placed, will search again at this time. [time]
  void set_next_event(Needle i, Time time) {
    places[i].next_event = time;
    motions[i].until = rounded_up(time);
  }
  /// Chooses the units of time again, as all needles will be placed now.
  void begin_again(Time now);
  /// Makes times from now on fit for place(), if they will soon not be. The threads share the work.
  void prepare(Time now, int threads);
  /// Until when they are.
  Time prepared_until() const;
  void renumber(const std::vector<Needle>& ranks);

  /// How far a path may be, from now - as a time of motions - for a time ahead, from what it is in
  /// the falling frame, as long as the needle stays in its bounding volume. [unit of length]
  float bend(float now, float ahead, const ClassCells& own) const;

  /// Where the centre of a seeker of a cell gets to along an axis in a time ahead. [unit of length]
  struct Range {
    float low, high;
  };
  Range path_along(int axis, const kernels::Seeker& seeker, float ahead) const;

  double since_base(Time t) const { return gas.clock.difference(t, base) * per_time; }

  ClassCells& class_of(Needle i) const {
    if (classes.size() == 1) return *classes.front();
    return *classes[class_of_extent(sizes, 2 * gas.body(i).reach())];
  }
  /// The cell of the common grid in which needle i has been placed, in the frame of its record.
  Cell common_cell_of(Needle i) const {
    return classes.size() == 1 ? places[i].cell : cell_around(i);
  }

  const Gas& gas;
  const bool falls, walled;                          ///< whether there is gravity, are walls
  double per_length;                                 ///< 1 / unit of length
  std::vector<std::unique_ptr<ClassCells>> classes;  ///< at least one
  std::vector<SizeClass> sizes;                      ///< of the same
  CellGrid grid;                                     ///< the common grid: of one class, its own
  double radius = 0;    ///< how far from where a needle is it may be placed, at most [L]
  double drift = 0;     ///< how far from its cell a needle may come, at most [L]
  double per_time = 0;  ///< 1 / unit of time; 0 before the first needle
  double longest_time = kernels::longest_time;  ///< largest present time [unit of time]
  Time base;
  LargeArray<Place> places;
  LargeArray<kernels::Motion> motions;
  LargeArray<Ball> balls;         ///< empty where none is kept
  LargeArray<float> half_widths;  ///< half the diameters; empty if all are equal [unit of length]

 private:
  Cell cell_around(Needle i) const;
  float rounded_up(Time t) const { return static_cast<float>(since_base(t) * (1 + 0x1p-20)); }
  void rebase(Time now, int threads);
  template <bool falls>
  bool place_one(Needle i, Time now, double half_length);
  void follow_wraps(Needle i, const Shift& image, Time now);
  struct Path {
    Vec3d centre, velocity;
  };
  /// The motion of a needle that is here now and has this velocity, in the frame of motions.
  Path path_of(const Vec3d& centre, const Vec3d& velocity, Time now) const {
    if (!gas.falls) return {centre, velocity};
    const double time = gas.clock.difference(now, base);
    return {centre - gas.gravity * (0.5 * time * time), velocity - gas.gravity * time};
  }
  /// `elapsed` is the time since the needle's record.
  void set_motion(Needle i, double elapsed, const Path& path, Time now);
  bool fits_words(Needle i, const Vec3d& centre) const;
  void write_entry(ClassCells& own, Needle i, const Vec3d& centre, const Vec3d& direction,
                   Time now);
  bool enter(ClassCells& own, Needle i, const Cell& cell);
};

}  // namespace needlework
