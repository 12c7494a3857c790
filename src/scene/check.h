// Checks of a whole scene: whether it agrees with its initial state, and which settings deserve a
// warning.
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

/// Completes a scene that starts from a given state, read from scene.initial.file if that is not
/// empty, with its count and box. If the scene gives them itself (not 0), they must agree, edges
/// to a relative 1e-12; otherwise throws InputError: "PLACE: expected ..., as in FILE". A count
/// that the scene does not give is attributed to the file in later messages.
void adopt_count_and_box(Scene& scene, const State& state);
/// The part of it that is about the count, so that it can be asked before the state is read. Fills
/// in nothing.
void require_count(const Scene& scene, std::size_t count);

}  // namespace needlework
