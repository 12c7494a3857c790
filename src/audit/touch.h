// Two needles that touch at one time: where, how fast, and what presses them together.
#pragma once

#include <array>

#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// More digits than double has, where the machine has them.
using Extended = long double;

/// Two needles relative to each other, for one image.
struct RelativeState {
  Vector<Extended> r, v;     ///< r1 - r2 and its rate of change
  Vector<Extended> u1, du1;  ///< directors and their rates of change
  Vector<Extended> u2, du2;
};
/// Of records of one time; `r12` is r1 - r2.
RelativeState relative_state(const Record& first, const Record& second, const Vector<double>& r12);

/// What follows from it where f = 0.
struct Touch {
  Touch(const RelativeState& state, const std::array<AuditedBody, 2>& bodies);

  Vector<Extended> n;            ///< along u1 x u2
  Extended sine;                 ///< |u1 x u2|
  std::array<Extended, 2> arms;  ///< s12, s21 [L]
  Vector<Extended> velocity;     ///< of the contact points relative to each other [L / time]
  Extended normal_velocity;      ///< its part along n
  Extended inverse_mass;         ///< by what a unit of impulse along n changes that [1 / M]
  Extended speeds;               ///< |v12| + (|w1| + |w2|) times the mean length [L / time]
  /// Of f'' in free flight over |u1 x u2|: by it the normal velocity changes [L / time^2], and by
  /// how much that is uncertain where a contact is known no better than to JointMotion::noise.
  Extended free_acceleration, noise;
  Extended rate;  ///< how fast all this changes, relatively [1 / time]

  /// Acceleration at which needles on this side press on each other; below 0 they part.
  Extended pressing(int side) const { return -side * free_acceleration; }
};

/// The state after an impulse along n on the first needle, given as the change of the normal
/// velocity that it makes.
RelativeState after_change(const RelativeState& state, const std::array<AuditedBody, 2>& bodies,
                           const Touch& touch, Extended change);

}  // namespace needlework::audit
