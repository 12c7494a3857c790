// Checks of the collision rule: the positions of the needles and their motion after a collision.
#pragma once

#include "needlework/simulation.h"
#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// Parameters of the collision rule.
struct Rule {
  double epsilon = 1, beta = -1;
  /// Where the needles part more slowly than at this fraction of their speeds, by which rounding
  /// could decide on the side, they may do so faster by up to four times that.
  double parting = 0;
};

/// Largest difference of a reported collision and of the records after it from the rule, in units
/// of what rounding may explain; a value above 1 is an error. `first` and `second` are the needles
/// before, `now` is the time of the collision. Speeds are per epoch.
double excess_over_rule(const Needle& first, const Needle& second, const Instant& now,
                        const Collision& collision, const Rule& rule, const Space& space);

}  // namespace needlework::audit
