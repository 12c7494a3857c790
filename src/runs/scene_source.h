// Scenes as the commands get them: a file, overrides, and the initial state that it may name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "needlework/state.h"
#include "src/runs/engine_choice.h"

namespace needlework::cli {

/// Arguments that say which scene is meant.
struct SceneArguments {
  std::string path;
  std::vector<std::string> overrides;
  EngineFlags engine;
};

/// A scene that is complete: where its initial state comes from a file, that is read, and count and
/// box are filled in from it.
struct LoadedScene {
  Scene scene;
  std::optional<State> initial;  ///< none: to be drawn
};

/// Reads the scene, applies overrides and flags, and reads the initial state if it is in a file.
/// Throws InputError for what is wrong in them, for an engine that is not on offer, and for more
/// needles than the memory of this machine can hold.
LoadedScene load_scene(const SceneArguments& arguments);

/// The same for a scene that was read already.
LoadedScene complete_scene(Scene given, const EngineFlags& flags);

/// The state's sums at time 0.
Totals totals_of(const State& state, double k);

/// Whether all is known of the gas from the start: elastic needles, drawn with equal temperatures.
bool starts_in_equilibrium(const Scene& scene);

/// needles.count / volume [L^-3].
double density_of(const Scene& scene);

}  // namespace needlework::cli
