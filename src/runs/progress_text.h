// Lines that say how far a run is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "src/runs/run_monitor.h"

namespace needlework::runs {

/// The share done (of [0, 1]), the wall time left, which is infinite if it is not known [s], and
/// more.
std::string progress_text(double fraction, double left, std::string_view more);

/// The line of a run: share done, time left, collisions, packing and pressure of bodies that grow,
/// the drift of energy and momentum, time, energy, the rate of collisions, and the age of the last
/// checkpoint. What matters most comes first, as narrow terminals leave out the rest: the 80
/// columns of most have room for the drift.
std::string progress_text(const Progress& progress);

/// As many of the items at its beginning, with ", " between them, as fit into the columns; of one
/// that is too long, its beginning.
std::string whole_items(std::string text, std::size_t columns);

}  // namespace needlework::runs
