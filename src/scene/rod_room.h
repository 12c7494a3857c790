// How much room rods of finite width take up, and leave.
#pragma once

#include <cstdint>

#include "needlework/scene.h"

namespace needlework {

/// No packing is known in which these rods take up a larger share of the volume: spheres of one
/// size cannot. Rods of one shape lie parallel in it, in gaps of layers below. Of several shapes,
/// each takes up as much of what the others leave. [1]
double densest_packing(const Composition& composition);

/// Tries of a rod, on average, when rods are inserted one by one, the largest first: by the scaled
/// particle theory of a fluid of convex bodies (R. M. Gibbons, Mol. Phys. 17, 81 (1969)), in which
/// rods are less in each other's way than where they have been inserted. Fixed ones that may
/// overlap each other leave places by chance. Infinite for a packing fraction of 1 or more of the
/// others.
double estimated_tries(const Composition& composition, double volume);

/// P V / (N T) of these bodies as a fluid, by the same theory. None of them is fixed.
double estimated_pressure(const Composition& composition, double volume);

}  // namespace needlework
