// The contact of a needle's tip with a plane wall, and when it comes.
//
// The height of a tip above the wall's surface, along the normal into the gas, is
//
//   h(s) = z + v s + g s^2 / 2 +- (1 + a s) (l/2) u_n(s) - A sin(2 pi (turns + f s)),
//
// with a the rate at which the needle grows, s the time since the needle's record, v relative to a
// surface of constant velocity, and u_n the component of its director. Where such a surface comes
// to rest, h has a kink: it is searched up to there, and from there on with the surface at rest, so
// that no step goes over it. The first contact is where it falls to 0. A bound on |h''| makes each
// step towards it safe: no contact is jumped over, and none is lost however flat it is. What double
// cannot decide goes to double-double.
#pragma once

#include <limits>

#include "kernels/contact_function.h"

namespace needlework::kernels {

/// A wall as the axis along its normal has it. It is at rest unless its amplitude is above 0 or it
/// has a velocity.
struct WallPlane {
  int axis = 0;          ///< 0 to 2
  int normal = 1;        ///< sign of the normal into the gas: 1 at the low side, -1 at the high one
  DoubleDouble place;    ///< coordinate, of the middle of its motion, at the record [L]
  double amplitude = 0;  ///< of its motion along the positive axis, A sin(2 pi turns) [L]
  double frequency = 0;  ///< turns per time [1 / time]
  double velocity = 0;   ///< along the positive axis, from the record until it halts [L / time]
  double halt = std::numeric_limits<double>::infinity();  ///< time from the record to then
  DoubleDouble halt_place;                                ///< where it rests from then on [L]

  /// The same from `halt` on.
  WallPlane halted() const {
    WallPlane out = *this;
    out.place = halt_place;
    out.velocity = 0;
    out.halt = std::numeric_limits<double>::infinity();
    return out;
  }
  /// The wall that stops lines where this one stops bodies of a radius [L] that grows at a speed.
  /// Of one at rest, its place is a double.
  WallPlane for_radius(double radius, double speed = 0) const {
    WallPlane out = *this;
    out.place = place + DoubleDouble(normal * radius);
    out.velocity += normal * speed;
    if (out.velocity == 0) out.place = to_double(out.place);
    out.halt_place = to_double(halt_place + DoubleDouble(normal * radius));
    return out;
  }
};

/// A needle from its record on, and a wall.
struct WallApproach {
  const Flight* flight = nullptr;
  double gravity = 0;  ///< acceleration along the positive axis [L / time^2]
  double half = 0.5;   ///< half the needle's length; 0: a sphere, of the radius [L]
  double radius = 0;   ///< of what touches the wall beyond the tips; its place has room for it [L]
  double growth = 0;   ///< `half` is 1 + growth s times as large at s; the wall moves by what the
                       ///< radius grows [1 / time]
  WallPlane wall;
  DoubleDouble turns;  ///< phase of the wall's motion at the record, in [0, 1)
  unsigned touching =
      0;                 ///< bit 0: the tip at +u has hit the wall at the record; bit 1: that at -u
  double tolerance = 0;  ///< rounding may have taken a tip so far beyond the wall [L]
  double resolution = 0;  ///< what events are apart at least; the contact is good to a part of it
                          ///< [time]
};

/// The first contact of a needle with a wall.
struct WallContact {
  bool found = false;
  double elapsed = 0;  ///< since the record [time]
  int tip = 0;         ///< 0: the one at +u, 1: the one at -u
  /// A tip that has hit the wall comes back so soon that its bounce is below what double resolves.
  bool unresolvable = false;
  bool across = false;  ///< the needle lies across the wall, beyond what rounding explains
};

/// The first contact at or after the record and up to `to`; there is none before `from`, which may
/// shorten the search and changes no bit of the result. A pure function of the approach, but for
/// contacts beyond `to`.
WallContact first_wall_contact(const WallApproach& approach, double from, double to);

/// The wall's surface at a time after the record, at which its phase is `turns`.
struct WallSurface {
  double place;     ///< coordinate [L]
  double velocity;  ///< along the positive axis [L / time]
};
WallSurface surface_at(const WallPlane& wall, const DoubleDouble& turns, double s = 0);

}  // namespace needlework::kernels
