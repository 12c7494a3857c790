// Amounts as people read them.
#pragma once

#include <string>

namespace needlework::runs {

/// A time span such as "1.25 s", "3 min 20 s" or "2 h 05 min"; [s] in.
std::string duration_text(double seconds);

/// Bytes such as "12.5 MB".
std::string bytes_text(double bytes);

}  // namespace needlework::runs
