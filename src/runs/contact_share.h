// What results say of the time that needles spend in contact with each other.
#pragma once

#include "needlework/simulation.h"
#include "src/observe/contact_share.h"

namespace needlework::runs {

/// The share of its time since the start that a needle has been in contact, the mean of all
/// needles. NaN at the start.
inline double contact_share(const Simulation& simulation, const SlidingContacts& contacts) {
  return observe::contact_share(contacts.time, simulation.needles(), simulation.time());
}

}  // namespace needlework::runs
