// Messages for the end of an inelastic collapse, at which a run cannot go on.
#pragma once

#include <cstdint>
#include <string>

#include "src/physics/ids.h"

namespace needlework {

/// A pair whose next bounce is below what double resolves.
struct PairCollapse {
  Id first, second;
  double time = 0;            ///< since the start of the run
  double gap = 0;             ///< distance of the contact points along the normal [L]
  double after = 0;           ///< time since the bounce before
  double root_tolerance = 0;  ///< of the accuracy in force
  double epsilon = 1;
  bool contact_time = false;  ///< whether the t_c rule is in force
};
std::string message_of(const PairCollapse& collapse);

/// Three needles or more that hit each other in turn until the clock stands still.
struct GroupCollapse {
  Id first, second;
  double time = 0;
  std::uint64_t collisions = 0;  ///< at that one instant
};
std::string message_of(const GroupCollapse& collapse);

}  // namespace needlework
