// The arguments by which commands name a scene, and the scene that they stand for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "needlework/parse.h"
#include "needlework/scene.h"
#include "src/cli/set_up.h"
#include "src/runs/loaded_scene.h"

namespace needlework::cli {

/// Options that take the place of keys in [engine].
struct EngineOptions {
  std::optional<std::string> threads;  ///< a number from 1 to 1024, or "auto"
  std::optional<std::string> isa;
};

/// SCENE, --set, --threads and --isa.
struct SceneArguments {
  std::string path;
  std::vector<std::string> overrides;
  EngineOptions engine;
  Provided provided = {};  ///< what the scene need not say
};

/// Puts options into the scene; messages about these keys name the options from then on.
void apply(const EngineOptions& options, Scene& scene);

/// Reads the scene, applies overrides and options, and reads the initial state if it is in a file.
/// Throws as read_scene() and runs::complete_scene() do. `set_up`, if there is one, is told the
/// limit of wall time before the state is read.
runs::LoadedScene load_scene(const SceneArguments& arguments, SetUp* set_up = nullptr);

}  // namespace needlework::cli
