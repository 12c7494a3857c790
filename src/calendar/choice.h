// Chooses the calendar for `auto`.
#pragma once

#include <string>

namespace needlework {

/// The calendar asked for by name. For `auto` on one thread, it is one that needs no tuning and is
/// close to the fastest for any number of needles (bench/queues), where all calendars take a few
/// percent of the time of an event. On several threads it is the only one that they can share.
inline std::string chosen_calendar(const std::string& asked, int threads) {
  if (asked != "auto") return asked;
  return threads > 1 ? "cell-calendar" : "tournament";
}

}  // namespace needlework
