// First contact with a plane wall of a needle that is not in free flight, but slides on another.
//
// The height of a tip above the wall is that of wall_contact.h, of a needle of which only is known
// where it is at any time and how fast it may move, turn and be accelerated. That bounds the second
// derivative of the height, so that intervals of time are halved until the height is above 0 or
// monotone in each. All is done in double: trajectories of sliding needles are known no better.
#pragma once

#include "kernels/trajectory_contact.h"
#include "kernels/wall_contact.h"

namespace needlework::kernels {

/// As first_wall_contact(), in the time in which the trajectory is known. Of the approach, flight
/// and gravity are not used, and its times begin with those of the trajectory, at s = 0.
WallContact trajectory_wall_contact(const Trajectory& trajectory, const WallApproach& approach,
                                    double from, double to);

}  // namespace needlework::kernels
