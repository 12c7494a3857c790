// Error messages for an inelastic collapse, after which a run cannot continue.
#pragma once

#include <cstdint>
#include <string>

#include "src/physics/ids.h"

namespace needlework {

/// A pair whose next bounce is too small or too soon to be resolved in double precision.
struct PairCollapse {
  Id first, second;
  double time = 0;            ///< since the start of the run
  double gap = 0;             ///< distance of the needles at the contact along its normal [L]
  double after = 0;           ///< time since the previous bounce
  double root_tolerance = 0;  ///< of the accuracy in force
  double epsilon = 1;
  bool contact_time = false;  ///< whether the t_c rule is in force
};
std::string message_of(const PairCollapse& collapse);

/// Three needles or more that hit each other in turn until the time no longer advances, or one that
/// hits walls.
struct GroupCollapse {
  Id first, second;  ///< the same for an event of one needle
  double time = 0;
  std::uint64_t collisions = 0;  ///< number of collisions at that one instant
  bool contact_time = false;     ///< whether a t_c of the scene is in force
  bool sliding = false;          ///< whether needles may slide on each other
};
std::string message_of(const GroupCollapse& collapse);

}  // namespace needlework
