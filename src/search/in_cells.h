// Needles in cells: the bounding volume of a needle is its cell and a fifth of its side around it.
//
// A needle that flies towards a cell and is nearly there is entered in it at once, where it can
// stay longer.
//
// Why no pair is left out: until a needle is placed again, its centre stays within `overlap` of its
// cell, and flies as its entry there says. The centres of two in contact are no farther apart than
// half their lengths and the distance of their axes; so the other one's entry is in a cell that is
// that near the seeker's path, with the overlap. Of these, approaching() leaves out those alone
// whose bounding spheres stay apart for all the time ahead.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/memory/prefetch.h"
#include "src/search/look.h"

namespace needlework {

struct InCells {
  /// Whether entries say when they have been written.
  static constexpr bool timed = true;
  static constexpr CellFit fit = CellFit::at_least;
  /// Measured at n L^3 = 0.72: from 1 to 1.3, 1.6 and 2, -2.9, -2.8 and -2.4 % of the instructions.
  static constexpr double tall = 1.3;

  /// By so much of the overlap a needle may be outside of its cell when it is placed. All of it
  /// would leave no room for rounding.
  static constexpr double ahead = 0x0.fp0;
  /// A needle that goes to and fro across a border, or crosses a corner, need not be placed again
  /// so often. [L]
  static double overlap_of(const CellGrid& grid) {
    const auto sides = grid.sides();
    return 0.2 * std::min({sides[0], sides[1], sides[2]});
  }

  template <bool falls>
  static Placement place(const ClassCells& own, const MotionFrame& frame,
                         const PresentNeedle& needle) {
    const Vec3d velocity = needle.motion.motion.velocity(needle.motion.start);
    const auto ahead = [&](double r, double v) { return r + std::copysign(own.ahead, v); };
    const Vec3d& centre = needle.centre;
    const Cell cell = own.grid.cell_of(
        {ahead(centre.x, velocity.x), ahead(centre.y, velocity.y), ahead(centre.z, velocity.z)});
    return {cell, needle.path.centre, needle.path.velocity * (frame.per_length / frame.per_time),
            own.grid.time_to_leave(cell, needle.motion, own.overlap)};
  }
  /// The same: its cell does not depend on how fast it is.
  template <bool falls>
  static Placement place_here(const ClassCells& own, const MotionFrame& frame,
                              const PresentNeedle& needle) {
    return place<falls>(own, frame, needle);
  }
  static std::uint32_t word(const kernels::WordFormat& format, double coordinate, double velocity) {
    return format.with_velocity(coordinate, velocity);
  }

  // Of the needle that searches.

  static void read_entry(const ClassCells&, const NeedleCells::Slot&, kernels::Seeker&) {}
  static const float* centre(const kernels::Seeker& seeker) { return seeker.motion.r; }
  static const float* direction(const kernels::Seeker& seeker) { return seeker.motion.v; }
  /// How far from the segment that it sweeps its axis may be. [unit of length]
  static float own_reach(const ClassCells&, const kernels::Seeker& seeker) {
    return seeker.motion.half;
  }
  static float rounding(const ClassCells&) { return 0; }
  /// The box around its path in the time ahead.
  static void set_box(const MotionFrame& frame, double ahead, Look& look) {
    const float time = in_units(frame, ahead);
    for (int axis = 0; axis < 3; ++axis) put(frame.along(axis, look.seeker, time), axis, look);
  }
  /// The same around its path in the frame of motions.
  static void set_straight_box(const MotionFrame& frame, double ahead, Look& look) {
    const float time = in_units(frame, ahead);
    for (int axis = 0; axis < 3; ++axis) put(frame.along_line(axis, look.seeker, time), axis, look);
  }

  /// The same along x, where it flies past with less velocity by this. Returns 0, see
  /// in_capsules.h.
  static float fly_past(const MotionFrame& frame, double ahead, float, Look& look) {
    put(frame.along_line(0, look.seeker, in_units(frame, ahead)), 0, look);
    return 0;
  }

  // Of those that it looks for.

  static float longest_half(const Look& look) { return look.cells->longest_half + look.touching; }
  /// Where bodies differ, what one reaches, and what comes on top of it.
  static float reach_of(float half, float half_width) { return half + half_width; }
  static float besides_reach(const Look& look) { return look.touching - look.cells->widest_half; }
  /// How far from their path, or axis, they may be in contact. [unit of length]
  static float reach(const ClassCells& there) { return there.longest_half; }
  /// How far from that contact their entries may be: the cells are looked at with their overlap.
  static float with_entries(const ClassCells&, float reach) { return reach; }
  static void prefetch(const kernels::NeedleBlock& block) {
    needlework::prefetch(&block.word);
    needlework::prefetch(&block.needle);
    needlework::prefetch(&block.time);
  }
  static kernels::Scan scan(const kernels::NearKernels& kernels,
                            const kernels::Surroundings& around, const Look& look,
                            const kernels::Found& found) {
    return kernels.approaching(around, look.seeker, found);
  }

 private:
  // A needle at rest may stay longer than floats can say.
  static float in_units(const MotionFrame& frame, double ahead) {
    return static_cast<float>(
        std::min<double>(ahead * frame.per_time, std::numeric_limits<float>::max()));
  }
  static void put(const MotionFrame::Range& range, int axis, Look& look) {
    look.low[axis] = range.low;
    look.high[axis] = range.high;
  }
};

}  // namespace needlework
