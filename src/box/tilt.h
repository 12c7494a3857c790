// A sheared box as other programs have it: a cell with edges (Lx, 0, 0), (xy, Ly, 0) and
// (0, 0, Lz), whose tilt xy is the slide of the row of boxes above, and that a needle's centre is
// within. A whole number of edges may be added to a tilt: the lattice stays the same, and boxes are
// counted otherwise.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/double_double.h"
#include "needlework/state.h"
#include "src/box/box.h"

namespace needlework {

/// A tilt as a number of edges and the rest.
struct Tilt {
  double rest = 0;         ///< [L]
  std::int32_t edges = 0;  ///< modulo 2^32

  /// Boxes that were counted for the tilt, as they are counted for the rest.
  Shift counted(const Shift& shift) const {
    const auto rows = static_cast<std::uint32_t>(edges) * static_cast<std::uint32_t>(shift[1]);
    return shift + Shift{static_cast<std::int32_t>(rows), 0, 0};
  }
};

/// Of a tilt xy of any finite size, in a box with this edge along x [L]. The rest is from 0 to
/// below the edge, as State has its slide.
inline Tilt reduced_tilt(double xy, double edge) {
  const Wrapped wrapped = Box({edge, edge, edge}).wrap_at_rest({xy, 0, 0});
  // Such numbers have no digits after the point, and mean nothing.
  if (!(std::abs(wrapped.boxes[0]) < 0x1p53)) return {};
  const auto edges = static_cast<std::uint32_t>(static_cast<std::int64_t>(wrapped.boxes[0]));
  return {wrapped.place[0], static_cast<std::int32_t>(edges)};
}

/// The needles of a state in their cell, with xy from -Lx / 2 to below Lx / 2. In a box that is not
/// sheared they are where they are.
class TiltedCell {
 public:
  /// The state must outlive this object.
  explicit TiltedCell(const State& state)
      : state_(&state), is_sheared_(state.slide != 0 || state.shear_rate != 0) {
    const double edge = state.box[0];
    const bool is_beyond_half = is_sheared_ && state.slide >= edge / 2;
    from_slide_.rest = is_beyond_half ? state.slide - edge : state.slide;  // exact
    from_slide_.edges = is_beyond_half ? 1 : 0;
  }

  bool is_sheared() const { return is_sheared_; }
  double xy() const { return from_slide_.rest; }  ///< [L]
  /// The edges [L].
  std::array<Vector, 3> vectors() const {
    const Vector& box = state_->box;
    return {Vector{box[0], 0, 0}, Vector{xy(), box[1], 0}, Vector{0, 0, box[2]}};
  }

  /// Of a needle: the centre, which is moved along x alone, so that the velocity is that of the
  /// state, and the boxes that are to be added to it to follow its path [L].
  Vector position(std::size_t i) const { return inside(state_->position[i]); }
  Shift image(std::size_t i) const {
    const Shift counted = state_->image.empty() ? Shift{} : state_->image[i];
    const auto moved = static_cast<std::int32_t>(boxes_along_x(state_->position[i]));
    return from_slide_.counted(counted) + Shift{moved, 0, 0};
  }
  /// Any centre, moved along x.
  Vector inside(const Vector& centre) const {
    const double boxes = boxes_along_x(centre);
    if (boxes == 0) return centre;
    return {to_double(DoubleDouble(centre[0]) - two_prod(boxes, state_->box[0])), centre[1],
            centre[2]};
  }

 private:
  double boxes_along_x(const Vector& centre) const {
    if (!is_sheared_) return 0;
    const double boxes =
        std::floor((centre[0] - xy() * (centre[1] / state_->box[1])) / state_->box[0]);
    return std::abs(boxes) < 0x1p31 ? boxes : 0;  // a centre that is too far away stays there
  }

  const State* state_;
  bool is_sheared_;
  Tilt from_slide_;  // of the slide: xy, and the edges by which it is less
};

}  // namespace needlework
