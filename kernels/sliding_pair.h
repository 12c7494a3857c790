// Two needles in contact: what holds them there, without friction.
//
// A force lambda n on the first needle at arm s12, and -lambda n on the second at s21, keeps
// f = r12 . (u1 x u2) at 0 while the needles slide on each other:
//
//   m1 v1' = lambda n,  I1 w1' = s12 lambda u1 x n,  m2 v2' = -lambda n,  I2 w2' = -s21 lambda u2 x
//   n.
//
// A force that both needles feel in proportion to their masses drops out: everything here is seen
// from a frame that falls with it. The centre of mass moves uniformly in that frame, so only the
// distance of the centres is kept, and momentum is conserved exactly.
#pragma once

#include "kernels/vec3.h"

namespace needlework::kernels {

/// A needle as a body.
struct SlidingBody {
  double half = 0.5;    ///< half its length [L]
  double mass = 1;      ///< [M]
  double inertia = 1.;  ///< about an axis through its centre, across it [M L^2]
};

/// The two needles of a contact.
struct SlidingBodies {
  SlidingBody first, second;
};

/// Where the needles are relative to each other, and how they move.
struct SlidingState {
  Vec3d r;                  ///< r1 - r2, of one periodic image [L]
  Vec3d v;                  ///< v1 - v2 [L / time]
  Vec3d u_first, u_second;  ///< directors [1]
  Vec3d w_first, w_second;  ///< angular velocities, normal to the directors [1 / time]
};

/// The contact of two needles that are not parallel.
struct SlidingContact {
  Vec3d normal;           ///< n = (u1 x u2) / |u1 x u2|
  double sin_angle = 0;   ///< |u1 x u2|
  double gap = 0;         ///< f / |u1 x u2|: distance of the needles' lines, with its sign [L]
  double arm_first = 0;   ///< s12 [L]
  double arm_second = 0;  ///< s21 [L]
  double speed = 0;       ///< V_n: of the contact points, along n [L / time]
  double inverse = 0;     ///< M_nn: what one unit of impulse changes V_n by [1 / M]
  double force =
      0;  ///< lambda, the force along n on the first needle that keeps f'' at 0 [M L / time^2]
  double noise = 0;  ///< what rounding may have changed the force by [M L / time^2]
  double rate = 0;   ///< how fast all this changes, relatively [1 / time]
};
SlidingContact sliding_contact(const SlidingBodies& bodies, const SlidingState& state);

/// The state after an impulse along the contact's normal, on the first needle. [M L / time]
SlidingState after_impulse(const SlidingBodies& bodies, const SlidingState& state,
                           const SlidingContact& contact, double impulse);

/// Kinetic energy of the motion relative to the centre of mass. [M L^2 / time^2]
double sliding_energy(const SlidingBodies& bodies, const SlidingState& state);

}  // namespace needlework::kernels
