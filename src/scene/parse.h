// Reads scene files: TOML, strict, with errors that name line, key, value and what was expected.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "src/scene/scene.h"

namespace needlework {

/// Parses the text of a scene. `name` is used in messages. Each override reads
/// "section.key=value" with the value in TOML, or a bare word for a string; it replaces the key.
/// Throws InputError: "NAME: line N: section.key = VALUE: expected ...", or for an override
/// "--set section.key=VALUE: expected ...".
Scene parse_scene(std::string_view text, std::string_view name,
                  std::span<const std::string> overrides = {});

/// Reads and parses a scene file. Throws IoError when it cannot be read.
Scene read_scene(const std::string& path, std::span<const std::string> overrides = {});

}  // namespace needlework
