// Checks of a whole scene: whether it agrees with the state it starts from, what deserves a
// warning.
#pragma once

#include <string>
#include <vector>

#include "src/scene/scene.h"

namespace needlework {

/// One sentence for each setting that is allowed but hardly meant, beginning with its key: an
/// inelastic gas without the t_c rule, end conditions that cannot be met, output that goes nowhere.
/// Overrides and flags must have been applied.
std::vector<std::string> warnings(const Scene& scene);

/// Completes a scene that starts from scene.initial.file by the count and the box of the state read
/// there. Where the scene gives them itself (not 0), they must agree, edges to a
/// relative 1e-12, else InputError: "needles.KEY = VALUE: expected ..., as in FILE".
void adopt_count_and_box(Scene& scene, const State& state);

}  // namespace needlework
