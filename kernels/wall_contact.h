// The contact of a needle's tip with a plane wall, and when it comes.
//
// The height of a tip above the wall's surface, along the normal into the gas, is
//
//   h(s) = z + v s + g s^2 / 2 +- (l/2) u_n(s) - A sin(2 pi (turns + f s)),
//
// with s the time since the needle's record and u_n the component of its director. The first
// contact is where it falls to 0. A bound on |h''| makes each step towards it safe: no contact is
// jumped over, and none is lost however flat it is. What double cannot decide goes to
// double-double.
#pragma once

#include "kernels/contact_function.h"

namespace needlework::kernels {

/// A wall as the axis along its normal has it. It is at rest unless its amplitude is above 0.
struct WallPlane {
  int axis = 0;          ///< 0 to 2
  int normal = 1;        ///< sign of the normal into the gas: 1 at the low side, -1 at the high one
  double place = 0;      ///< coordinate, of the middle of its motion [L]
  double amplitude = 0;  ///< of its motion along the positive axis, A sin(2 pi turns) [L]
  double frequency = 0;  ///< turns per time [1 / time]
};

/// A needle from its record on, and a wall.
struct WallApproach {
  const Flight* flight = nullptr;
  double gravity = 0;  ///< acceleration along the positive axis [L / time^2]
  double half = 0.5;   ///< half the needle's length; 0: a sphere, of the radius [L]
  double radius = 0;   ///< of what touches the wall beyond the tips; its place has room for it [L]
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

/// The wall's surface at a phase.
struct WallSurface {
  double place;     ///< coordinate [L]
  double velocity;  ///< along the positive axis [L / time]
};
WallSurface surface_at(const WallPlane& wall, const DoubleDouble& turns);

}  // namespace needlework::kernels
