// The mass of all needles that move.
#pragma once

#include "needlework/composition.h"

namespace needlework {

/// Of all needles of all species, but for those that are fixed. [m]
inline double total_mass(const Composition& composition) {
  double out = 0;
  for (const Species& each : composition.species()) {
    if (!each.fixed) out += each.mass * static_cast<double>(each.count);
  }
  return out;
}

}  // namespace needlework
