// Makes event loops. Those of each calendar are compiled in a file of its own, loops/*.cpp, as
// there are as many as searches times effects.
#pragma once

#include <memory>
#include <string>

#include "src/calendar/calendar.h"
#include "src/engine/loop.h"
#include "src/search/setup.h"

namespace needlework {

/// The event loop with this calendar and search, and with the effects that the scene calls for.
/// `run` must outlive it. Throws InputError for a search that does not exist.
template <Calendar Queue>
std::unique_ptr<Loop> make_loop_with(const Scene& scene, Run& run, const std::string& search,
                                     const SearchSetup& setup);

}  // namespace needlework
