// What `auto` stands for.
#pragma once

#include <string>

namespace needlework {

/// The calendar asked for by name. By `auto`: for one thread, one that is near the fastest at any
/// number of needles (bench/queues), where all take a few per cent of an event's time, and needs no
/// width to be tuned; for several, the one that they can share.
inline std::string chosen_calendar(const std::string& asked, int threads) {
  if (asked != "auto") return asked;
  return threads > 1 ? "cell-calendar" : "tournament";
}

}  // namespace needlework
