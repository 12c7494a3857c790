// The completed fraction of a run, from which its end is predicted.
#pragma once

#include "needlework/scene.h"
#include "needlework/totals.h"

namespace needlework {

/// The collisions so far as a fraction, in [0, 1], of those expected until the first end
/// condition. It is exact if collisions are counted. For a time or an energy it follows from
/// Haff's law, E(t) = E(0) / (1 + t / t0)^2: the number of collisions is proportional to log(1 + t
/// / t0), and t0 follows from the present energy. `elapsed` is the wall time of the run so far
/// [s].
double completed_fraction(const Scene::Until& until, const Totals& initial, const Totals& now,
                          double count, double elapsed);

}  // namespace needlework
