// Needles in capsules: the bounding volume of a needle is what is within a radius of where its axis
// is in the middle of its time there.
//
// Why no pair is left out: before and after that middle no point of a needle moves by more than the
// radius, so its axis stays in its capsule until it is placed again. Two in contact have capsules
// with axes no farther apart than both radii and the distance of their axes; so the other one's
// entry, the centre of its capsule, is within that and half its length of the seeker's axis, and in
// a cell that is so near. Of these, overlapping() leaves out those alone whose axes, as they have
// been entered, are farther apart.
#pragma once

#include <cmath>

#include "src/memory/prefetch.h"
#include "src/search/look.h"

namespace needlework {

struct InCapsules {
  static constexpr bool timed = false;
  static constexpr CellFit fit = CellFit::nearest;
  /// Measured at n L^3 = 11.6: to 1.3, 1.6 and 2, -0.1, +1.3 and +4.6 % of the instructions.
  static constexpr double tall = 1;

  static constexpr double ahead = 0;
  static double overlap_of(const CellGrid&) { return 0; }

  template <bool falls>
  static Placement place(const ClassCells& own, const MotionFrame& frame,
                         const PresentNeedle& needle) {
    const FreeFlight& motion = needle.motion.motion;
    const double now = needle.motion.start;
    const double speed =
        motion.fastest(now, now) + needle.half_length * motion.fastest_rotation(now, now);
    const double half = frame.half_time_within<falls>(own.radius, speed);
    const double middle = std::isfinite(half) ? now + half : now;
    return placed(own, motion, middle, 2 * half);
  }
  /// The same with the middle now, so that it stays half as long.
  template <bool falls>
  static Placement place_here(const ClassCells& own, const MotionFrame& frame,
                              const PresentNeedle& needle) {
    const Placement ahead = place<falls>(own, frame, needle);
    return placed(own, needle.motion.motion, needle.motion.start, 0.5 * ahead.stay);
  }
  static std::uint32_t word(const kernels::WordFormat& format, double coordinate, double director) {
    return format.with_director(coordinate, director);
  }

  // Of the needle that searches, see in_cells.h.

  static void read_entry(const ClassCells& own, const NeedleCells::Slot& slot,
                         kernels::Seeker& seeker) {
    const kernels::NeedleBlock& block = own.cells[slot.block];
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t word = block.word[axis][slot.lane];
      seeker.r[axis] = static_cast<float>(own.format.coordinate(word));
      seeker.u[axis] = own.format.director(word);
    }
  }
  static const float* centre(const kernels::Seeker& seeker) { return seeker.r; }
  static const float* direction(const kernels::Seeker& seeker) { return seeker.u; }
  static float own_reach(const ClassCells& own, const kernels::Seeker&) { return own.in_capsules; }
  static float rounding(const ClassCells& own) { return static_cast<float>(own.format.step()); }
  static void set_box(const MotionFrame&, double /*ahead*/, Look& look) {
    const kernels::Seeker& seeker = look.seeker;
    for (int axis = 0; axis < 3; ++axis) {
      const float beside = seeker.motion.half * std::abs(seeker.u[axis]);
      look.low[axis] = seeker.r[axis] - beside;
      look.high[axis] = seeker.r[axis] + beside;
    }
  }
  static void set_straight_box(const MotionFrame& frame, double ahead, Look& look) {
    set_box(frame, ahead, look);
  }

  /// Seen from another row, the capsule flies past: it stays in one around where it is in the
  /// middle of the time ahead, wider by how far it gets in half of that. Returns by how much.
  /// [unit of length]
  static float fly_past(const MotionFrame& frame, double ahead, float velocity, Look& look) {
    const float way = velocity * static_cast<float>(0.5 * ahead * frame.per_time);
    look.seeker.r[0] -= way;
    const float beside = look.seeker.motion.half * std::abs(look.seeker.u[0]);
    look.low[0] = look.seeker.r[0] - beside;
    look.high[0] = look.seeker.r[0] + beside;
    look.distance += std::abs(way);
    return std::abs(way);
  }

  // Of those that it looks for.

  static float longest_half(const Look& look) { return look.cells->longest_half; }
  static float reach_of(float half, float) { return half; }
  static float besides_reach(const Look&) { return 0; }
  static float reach(const ClassCells& there) { return there.in_capsules; }
  static float with_entries(const ClassCells& there, float reach) {
    return reach + (there.longest_half + static_cast<float>(there.format.step()));
  }
  static void prefetch(const kernels::NeedleBlock& block) {
    needlework::prefetch(&block.word);
    needlework::prefetch(&block.needle);
  }
  static kernels::Scan scan(const kernels::NearKernels& kernels,
                            const kernels::Surroundings& around, const Look& look,
                            const kernels::Found& found) {
    return kernels.overlapping(around, look.seeker, 0.5f * look.distance, found);
  }

 private:
  static Placement placed(const ClassCells& own, const FreeFlight& motion, double middle,
                          double stay) {
    const Vec3d centre = motion.centre(middle);
    return {own.grid.cell_of(centre), centre, motion.director(middle), stay};
  }
};

}  // namespace needlework
