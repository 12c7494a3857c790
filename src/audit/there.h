// A needle at the time of an event, with 113 bits, and where it must be after it.
#pragma once

#include "src/audit/excess.h"
#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// A needle at one time after its record.
struct There {
  Vector<Quad> r, u, v, w;
  double flown, turned;  ///< distance, and angle

  There(const Needle& needle, const Vector<double>& gravity, const Instant& now) {
    const auto flight = needle.flight_as<Ball<Quad>>();
    const Ball<Quad> age = elapsed<Quad>(needle.record.time, now);
    const Pose<Ball<Quad>> pose = flight.at(age);
    const Vector<Ball<Quad>> spin = needle.spin(pose);
    const Quad t = age.middle;
    for (int axis = 0; axis < 3; ++axis) {
      const Quad g = gravity[axis];
      r[axis] = pose.r[axis].middle + g * t * t / 2;
      v[axis] = flight.v[axis].middle + g * t;
      u[axis] = pose.u[axis].middle;
      w[axis] = spin[axis].middle;
    }
    flown = magnitude(Quad(norm(v) * t)) + norm(gravity) * magnitude(t) * magnitude(t) +
            needle.worn * needle.body.extent();
    turned = magnitude(Quad(flight.omega.middle * t)) + needle.worn;
  }
};

/// Adds how far centre and director after an event are from where the needle was. Centres may be
/// wrapped into the box.
inline void add_place(Excess& excess, const There& there, const Vector<double>& position,
                      const Vector<double>& orientation, const Space& space) {
  constexpr double unit = 0x1p-53;
  for (int axis = 0; axis < 3; ++axis) {
    Quad moved = there.r[axis] - Quad(position[axis]);
    moved -= Quad(space.box[static_cast<std::size_t>(axis)]) * space.boxes_along<Quad>(axis, moved);
    excess.add(moved, space.around(position).rounding() + 16 * unit * there.flown);
    excess.add(there.u[axis] - Quad(orientation[axis]), 8 * unit * (2 + there.turned));
  }
}

}  // namespace needlework::audit
