// Lines that say how far a run is.
#pragma once

#include <string>
#include <string_view>

#include "needlework/totals.h"

namespace needlework::runs {

/// The share done (of [0, 1]) `elapsed` seconds into the work, the time left that follows from it,
/// and more.
std::string progress_text(double elapsed, double fraction, std::string_view more);

/// Collisions, time and energy of a run, whose energy per needle was `initial_energy` at the start.
std::string progress_of_run(const Totals& now, double initial_energy);

}  // namespace needlework::runs
