// What `auto` stands for.
#pragma once

namespace needlework {

/// For one thread, the calendar that is among the fastest at any number of needles (bench/queues),
/// the rest being equal: at 1e3 to 1e6 needles it takes a few per cent of an event's time. For
/// several, the one that they can share.
inline const char* auto_queue(int threads) { return threads > 1 ? "cell-calendar" : "tournament"; }

}  // namespace needlework
