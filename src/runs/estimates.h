// Estimates of the time of a run, made before it begins.
#pragma once

#include "needlework/initial_state.h"
#include "needlework/scene.h"

namespace needlework::runs {

/// Wall time per collision on one core of a server of 2.5 GHz [s]; density in [L^-3].
double estimated_seconds_per_collision(const Scene& scene, double density);

/// Wall time until the first event, on the same core [s]: drawing the state, and the first search
/// of all needles, which takes the longer the denser they are. Density in [L^-3].
double estimated_setup_seconds(const Scene& scene, double density);

/// Wall time of placing rods, on the same core [s]. Density in [L^-3].
double estimated_placing_seconds(const Scene& scene, double density, const PlannedPlacement& plan);

}  // namespace needlework::runs
