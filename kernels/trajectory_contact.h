// First contact of two needles of which at least one is not in free flight, but slides on a third.
//
// What is known of a needle's trajectory is where it is at any time, and how fast it may move, turn
// and be accelerated. That bounds the second derivative of the contact function f = r12 . (u1 x
// u2), so that intervals of time are halved until each has no root, or one. All is done in double:
// trajectories of sliding needles are known no better.
#pragma once

#include <algorithm>

#include "kernels/body_state.h"
#include "kernels/first_contact.h"

namespace needlework::kernels {

/// How a needle moves, with times counted from s = 0 of its pair.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  virtual BodyState at(double s) const = 0;

  /// Until when it is known. [time]
  double lasts = 0;
  /// Bounds that hold until then: on the speed and acceleration of the centre relative to a frame
  /// common to both needles of a pair, and on the angular ones.
  double speed = 0, acceleration = 0, turning = 0, turning_faster = 0;
};

/// Two needles and one periodic image.
struct TrajectoryPair {
  const Trajectory& first;
  const Trajectory& second;
  Vec3d shift;  ///< added to the second needle's centre [L]
  double half_first, half_second;
  Touch touch;
  double touch_within;  ///< as in Pair
};

/// As first_contact(), in the time in which both trajectories are known. Does not depend on `from`
/// and `until` but for whether there is a contact between them.
Contact trajectory_contact(const TrajectoryPair& pair, double from, double until,
                           EvaluationCounters& counters);
/// f at one time, continued from a touch. [L]
double trajectory_gap(const TrajectoryPair& pair, double s);
/// Sign of f' at s = 0.
int trajectory_side_after(const TrajectoryPair& pair);
/// The geometry of a contact.
ContactGeometry trajectory_geometry(const TrajectoryPair& pair, double s);

}  // namespace needlework::kernels
