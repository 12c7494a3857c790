// Checks of a whole scene: whether it agrees with the state it starts from, what deserves a
// warning.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework {

/// One sentence for each setting that is allowed but hardly meant, beginning with its key: an
/// inelastic gas without the t_c rule, end conditions that cannot be met, output that goes nowhere.
/// Overrides and flags must have been applied.
std::vector<std::string> warnings(const Scene& scene);
/// Those of the accuracy: keys without effect beside the others.
std::vector<std::string> accuracy_warnings(const Scene::Engine& engine);

/// How messages name a key of the scene: the place where it was given, or "KEY = VALUE" where that
/// is unknown.
std::string place_of(const Scene& scene, std::string_view key, std::string_view value);

/// Completes a scene that starts from scene.initial.file by the count and the box of the state read
/// there. Where the scene gives them itself (not 0), they must agree, edges to a
/// relative 1e-12, else InputError: "PLACE: expected ..., as in FILE". A count that the scene does
/// not give is named after the file from then on.
void adopt_count_and_box(Scene& scene, const State& state);

}  // namespace needlework
