// The bodies of all needles of a simulation.
#pragma once

#include "needlework/simulation.h"

namespace needlework::runs {

/// The numbers of each needle, in order of id, whether those of a species differ or not. Masses of
/// fixed needles, and their moments of inertia unless they are smooth spheres, are infinite.
OwnBodies bodies_of_needles(const Simulation& simulation);

}  // namespace needlework::runs
