// Drawn initial states.
#pragma once

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework {

/// Draws an initial state: centres and directors uniform, velocities Gaussian, total momentum 0
/// (N >= 2), temperatures exactly as asked for. A pure function of the scene's seed, the same on
/// every machine. Throws InputError for a count, box, temperature or property of needles that a
/// scene file could not hold (docs/scenes.md gives their ranges).
State draw_initial_state(const Scene& scene);

}  // namespace needlework
