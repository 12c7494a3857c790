// Lines that say how far a run is.
#pragma once

#include <string>
#include <string_view>

#include "src/runs/run_monitor.h"

namespace needlework::runs {

/// The share done (of [0, 1]), the wall time left, which is infinite if it is not known [s], and
/// more.
std::string progress_text(double fraction, double left, std::string_view more);

/// The line of a run: share done, time left, collisions, their rate, time, packing and pressure of
/// bodies that grow, energy, the age of the
/// last checkpoint, and the drift of energy and momentum. What matters most comes first, as narrow
/// terminals cut it off.
std::string progress_text(const Progress& progress);

}  // namespace needlework::runs
