// What is worth a warning in a scene that is valid.
#pragma once

#include <string>
#include <vector>

#include "src/scene/scene.h"

namespace needlework {

/// One sentence for each setting that is allowed but hardly meant, beginning with its key: an
/// inelastic gas without the t_c rule, end conditions that cannot be met, output that goes nowhere.
/// Overrides and flags must have been applied.
std::vector<std::string> warnings(const Scene& scene);

}  // namespace needlework
