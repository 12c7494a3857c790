// Estimates of what a run will need, made before it begins.
#pragma once

#include "needlework/initial_state.h"
#include "needlework/scene.h"

namespace needlework::runs {

/// Memory of a run of this scene at its peak [bytes].
double estimated_memory(const Scene& scene);

/// Wall time per collision on one core of a server of 2.5 GHz [s]; density in [L^-3].
double estimated_seconds_per_collision(const Scene& scene, double density);

/// Wall time until the first event, on the same core [s]: drawing the state, and the first search
/// of all needles, which takes the longer the denser they are. Density in [L^-3].
double estimated_setup_seconds(const Scene& scene, double density);

/// Wall time of placing rods, on the same core [s]. Density in [L^-3].
double estimated_placing_seconds(const Scene& scene, double density, const PlannedPlacement& plan);

/// Throws InputError naming needles.count if the run needs more memory than there is.
void require_memory(const Scene& scene);

}  // namespace needlework::runs
