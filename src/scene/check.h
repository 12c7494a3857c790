// Checks of a whole scene: which settings deserve a warning.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework {

/// One sentence, beginning with the key, for each setting that is allowed but probably not
/// intended: an inelastic gas without the t_c rule, end conditions that cannot be met, output that
/// is not written anywhere. Overrides and options must have been applied.
std::vector<std::string> warnings(const Scene& scene);
/// From this contact time on [mean free times] there is a warning, which says:
inline constexpr double long_contact = 0.1;
inline constexpr const char* effect_of_long_contact =
    "a large part of all collisions will be elastic, and the gas cools more slowly than in theory";

/// The warnings about accuracy: keys that have no effect together with the others.
std::vector<std::string> accuracy_warnings(const Scene::Engine& engine);

/// How messages name a key of the scene: the place where it was given, or "KEY = VALUE" if the
/// place is unknown.
std::string place_of(const Scene& scene, std::string_view key, std::string_view value);

}  // namespace needlework
