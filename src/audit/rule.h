// The collision rule, checked: where the needles are and how they move after a collision.
#pragma once

#include "needlework/simulation.h"
#include "src/audit/pair.h"

namespace needlework::audit {

/// Parameters of the rule; m = L = 1.
struct Rule {
  double epsilon = 1, beta = -1;
  double k = 6;
};

/// By how much the report of a collision and the needles' records after it differ from the rule, at
/// most, in units of what rounding may explain: above 1, something is wrong. `first` and `second`
/// are the needles before, `now` is the time of the collision. Speeds are per epoch.
double excess_over_rule(const Needle& first, const Needle& second, const Instant& now,
                        const Collision& collision, const Rule& rule, const Space& space);

}  // namespace needlework::audit
