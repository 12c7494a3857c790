// What `auto` stands for.
#pragma once

namespace needlework {

/// The calendar that is among the fastest at any number of needles (bench/queues), the rest being
/// equal: at 1e3 to 1e6 needles it takes a few per cent of an event's time.
inline constexpr const char* auto_queue = "tournament";

}  // namespace needlework
