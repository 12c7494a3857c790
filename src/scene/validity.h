// Whether a scene is valid. Whoever takes a scene asks here: the reader of scene files and their
// overrides (and with it C, Python and serve), Simulation and draw_initial_state() of a scene made
// in code, scenes that a state completes, and checkpoints. What is asked stands in
// src/scene/sections.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "needlework/scene.h"
#include "src/scene/section.h"

namespace needlework {

/// What the engine reads of every scene.
inline constexpr Aspects simulable = Aspect::species | Aspect::bodies | Aspect::pairs |
                                     Aspect::walls | Aspect::effects | Aspect::machine;
/// What an initial state is drawn from, but the seed, which may be any.
inline constexpr Aspects drawable =
    Aspect::bodies | Aspect::sizes | Aspect::walls | Aspect::room | Aspect::start;

/// Where a scene comes from, for messages.
struct SceneOrigin {
  std::string_view name = "the scene";  ///< what is said of no key
  /// Keys as Scene::places has them, in the order in which they were given.
  std::span<const std::string> given = {};
  bool has_places = true;  ///< whether Scene::places are to be believed
};

/// Throws InputError for the first value of these aspects that is not in the range of its key, that
/// no scene file could hold: "the scene: SECTION.KEY = VALUE: expected ...". Keys that [[species]]
/// replace are looked at only for Aspect::restored.
void require_ranges(const Scene& scene, Aspects aspects);

/// Throws InputError, "PLACE: expected ...", for the first rule of these aspects that is broken.
/// Each value that they are about must be in its range.
void require_rules(const Scene& scene, Aspects aspects, const SceneOrigin& origin = {});

/// Both.
void require_valid(const Scene& scene, Aspects aspects);

/// Throws InputError for a scene that was restored from a file, which may be damaged, unless it is
/// one that a text could describe, completed by the state that it starts from.
void require_restored(const Scene& scene);

}  // namespace needlework
