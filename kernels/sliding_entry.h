// Whether a collision begins a contact: a train of bounces that becomes ever faster is replaced by
// the motion that it tends to.
#pragma once

#include "kernels/sliding_motion.h"

namespace needlework::kernels {

/// Why a collision begins a contact, or does not.
enum class SlidingDecision : unsigned char {
  Enters,        ///< it is done with epsilon = 0, and the needles stay in contact
  Elastic,       ///< epsilon = 1: no train comes to an end
  Crowded,       ///< one of the needles has just touched another one: see `crowded` below
  Parts,         ///< nothing presses the needles together again
  LongFlight,    ///< the flight to the next bounce is not below the threshold
  ShortContact,  ///< the contact would end within twice the remaining train: no collapse
};

struct SlidingEntry {
  SlidingDecision decision = SlidingDecision::Parts;
  int side = 0;        ///< sign of f before the collision, and during the contact
  double epsilon = 0;  ///< with which the collision is to be done, if it does not enter
  double loss = 0;     ///< energy that the plastic impulse takes [M L^2 / time^2]
  double train = 0;    ///< what was left of the train, from this collision on [time]
  SlidingState after;  ///< if it enters: in contact, after the plastic impulse
};

/// A collision with a coefficient of restitution in [0, 1], from the state before it, f = 0 up to
/// rounding and V_n other than 0. `below` is the threshold for the flight to the next bounce
/// [time]; epsilon = 0 knows no flight, and needs none.
///
/// A needle that is pressed between two others would be in two contacts. Where one of the two has
/// touched another needle a short time before, the collision is `crowded` and never begins a
/// contact. Its epsilon is raised, at most to 1, so that the flight to the next bounce lasts for
/// about the threshold where the needles are pressed together as much as needles in contact are.
SlidingEntry sliding_entry(const SlidingBodies& bodies, const SlidingState& before, double epsilon,
                           double below, bool crowded = false);

}  // namespace needlework::kernels
