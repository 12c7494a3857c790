// The names of all calendars.
#pragma once

#include <string>
#include <vector>

namespace needlework {

/// The values of `engine.queue` besides "auto", in the order of the list in src/calendar/all.h.
const std::vector<std::string>& calendar_names();

}  // namespace needlework
