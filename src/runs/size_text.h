// How the bodies of a species differ, in words.
#pragma once

#include <string>
#include <vector>

#include "needlework/composition.h"

namespace needlework::runs {

/// What bodies these are, such as "k = 6, uniform rods" or "spheres of diameter 1".
std::string shape_text(const Species& species);

/// A line for each number in which they differ: how it is drawn, and what came of it, such as
/// "length lognormal of mean 1, width 0.3: drawn mean 0.986, width 0.296, from 0.39 to 2.4".
std::vector<std::string> size_lines(const Species& species);

}  // namespace needlework::runs
