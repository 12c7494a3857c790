// Times as people read them.
#pragma once

#include <string>

namespace needlework::runs {

/// A time span such as "1.25 s", "3 min 20 s" or "2 h 05 min"; [s] in.
std::string duration_text(double seconds);

}  // namespace needlework::runs
