// The keys of a recorded scene that a page names.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "needlework/scene.h"

namespace needlework::report {

/// `text` as a file of a run holds it: the scene as read, and then a line "# --set key=value" for
/// each key that was set over it, which is set again here. `name` is used nowhere but in errors.
/// Nothing for a text that this version cannot parse, such as a scene with keys of a later one.
std::optional<Scene> recorded_scene(const std::string& text, const std::string& name);

nlohmann::ordered_json scene_facts(const Scene& scene);

}  // namespace needlework::report
