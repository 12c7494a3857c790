// What this build can do on this machine, for front ends that ask before they make a scene.
#pragma once

#include <string>
#include <vector>

namespace needlework::runs {

/// "threads", "files/h5md", "isa/NAME" of each instruction set and "effect/NAME" of each effect.
std::vector<std::string> capabilities();

}  // namespace needlework::runs
