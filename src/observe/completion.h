// How much of a run is done: the basis of a forecast of its end.
#pragma once

#include "needlework/scene.h"
#include "needlework/totals.h"

namespace needlework {

/// The share of a run's collisions that has happened, in [0, 1], as a fraction of those expected
/// until the first of the end conditions: exact where collisions are counted; for a time or an
/// energy from Haff's law, E(t) = E(0) / (1 + t / t0)^2, in which the collisions so far are
/// proportional to log(1 + t / t0) and t0 follows from the energy reached. `elapsed` is the wall
/// time of the run so far [s].
double completed_fraction(const Scene::Until& until, const Totals& initial, const Totals& now,
                          double count, double elapsed);

}  // namespace needlework
