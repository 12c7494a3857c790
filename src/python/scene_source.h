// Scenes from Python: text, dictionaries written as text, or files.
#pragma once

#include <optional>
#include <string>

#include "needlework/scene.h"
#include "needlework/state.h"
#include "src/runs/loaded_scene.h"

namespace needlework::python {

/// Where a scene comes from.
struct SceneSource {
  std::optional<std::string> text;  ///< TOML; none: in the file `name`
  std::string name;                 ///< how messages name it
  bool has_lines = true;            ///< whether numbers of lines mean anything to the user
};

/// A scene that is ready to run, from `state` if there is one, whose box is that of the scene.
/// Throws InputError and IoError as the program does.
runs::LoadedScene load_scene(const SceneSource& source, std::optional<State> state);

}  // namespace needlework::python
