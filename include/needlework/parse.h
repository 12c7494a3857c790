// Reads scene files: TOML, strict, with errors that name line, key, value and what was expected.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "needlework/scene.h"

namespace needlework {

struct Override;  // document.h

/// The longest scene that is read [bytes].
inline constexpr std::size_t max_scene_bytes = std::size_t{1} << 20;

/// Parses the text of a scene. `name` is used in messages.
///
/// Each override reads "section.key=value" ("title=value") with the value in TOML; what is no TOML
/// value is taken as a string, so that engine.search=all-pairs needs no quotes. An override
/// replaces or adds its key before anything is checked, and the last one for a key counts. It never
/// removes a key, but two replace alternatives that the file has chosen: collisions.tc and
/// collisions.tc_relative each replace the other, and initial.file replaces initial.t_tr and
/// initial.t_rot. A temperature given over a file's initial.file stays an error, as it could mean
/// either to redraw or to rescale.
///
/// Without overrides the scene's text is the text as read; each override is added to it as a
/// comment "# --set section.key=value". needles.count and needles.box may be missing only when
/// initial.file is given, and are 0 then.
///
/// Throws InputError with a single message about the first error (syntax, then the file by line,
/// then the overrides in order, then missing keys): "NAME: line N: section.key = VALUE: expected
/// ...", "NAME: section.key is missing: expected ...", "NAME: line N: REASON" for what is no TOML,
/// or "--set section.key=VALUE: expected ...". Messages hold no control characters.
Scene parse_scene(std::string_view text, std::string_view name,
                  std::span<const std::string> overrides = {});

/// The same with overrides that messages may name otherwise than --set.
Scene parse_overridden_scene(std::string_view text, std::string_view name,
                             std::span<const Override> overrides);

/// The text of a scene file, or as much of a longer one as shows that it is too long. Throws
/// IoError when it cannot be read.
std::string read_scene_text(const std::string& path);

/// Reads and parses a scene file. Throws IoError when it cannot be read.
Scene read_scene(const std::string& path, std::span<const std::string> overrides = {});

}  // namespace needlework
