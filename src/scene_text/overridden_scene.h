// Scenes with keys that are given outside of their file, by others than --set.
#pragma once

#include <span>
#include <string_view>

#include "needlework/parse.h"
#include "src/scene_text/document.h"

namespace needlework {

/// parse_scene() for overrides that messages may attribute to another source than --set.
Scene parse_overridden_scene(std::string_view text, std::string_view name,
                             std::span<const Override> overrides, Provided provided = {});

}  // namespace needlework
