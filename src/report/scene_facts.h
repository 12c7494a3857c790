// The keys of a recorded scene that a page names.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework::report {

/// `text` as a file of a run holds it: the scene as read, and then a line "# --set key=value" for
/// each key that was set over it, which is set again here. `bodies` and their counts are those of
/// the file, which a scene that began with the state of another file need not say. `name` is used
/// nowhere but in errors. Nothing for a text that this version cannot parse, such as a scene with
/// keys of a later one.
std::optional<Scene> recorded_scene(const std::string& text, const std::string& name,
                                    const Bodies& bodies, const std::vector<double>& counts);

nlohmann::ordered_json scene_facts(const Scene& scene);

}  // namespace needlework::report
