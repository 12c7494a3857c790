// Reads scene files in strict TOML. Errors name line, key, value and what was expected.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "needlework/scene.h"

namespace needlework {

/// What a caller provides in code, so that the text of a scene may leave it out.
struct Provided {
  bool state = false;  ///< the initial state: count and box may be missing, and are then 0; keys
                       ///< that describe another state are errors
  bool end = false;    ///< the conditions that end the run: [until] may be missing
};

/// Parses the text of a scene. `name` is used in messages.
///
/// Each override reads "section.key=value" or "title=value" with a value in TOML. A value that is
/// not TOML is read as a string, so that engine.search=all-pairs needs no quotes. An override
/// replaces or adds its key before anything is checked; the last override of a key wins. Overrides
/// do not remove other keys, with exceptions for alternatives in the file: collisions.tc and
/// collisions.tc_relative replace each other, so do output.series_every and
/// output.series_per_decade, output.frames_every and output.frames, and initial.file replaces
/// initial.t_tr and initial.t_rot. Overriding a temperature is an error if the file has
/// initial.file, because it could mean either to draw velocities or to rescale them.
///
/// Without overrides the scene's text is the text as read. Each override is appended to it as a
/// comment "# --set section.key=value". needles.count and needles.box may be missing only if
/// initial.file is given or the caller provides the state; they are then 0.
///
/// Throws InputError with one message about the first error (syntax, then the file by line, then
/// the overrides in order, then missing keys): "NAME: line N: section.key = VALUE: expected ...",
/// "NAME: section.key is missing: expected ...", "NAME: line N: REASON" for text that is not TOML,
/// or "--set section.key=VALUE: expected ...". Messages contain no control characters. A scene that
/// draws the sizes of more bodies than there is memory for is an error, too.
Scene parse_scene(std::string_view text, std::string_view name,
                  std::span<const std::string> overrides = {}, Provided provided = {});

/// Parses the text of a scene as a file of a run holds it, Scene::text: overrides are the comments
/// at its end, and [until] may be missing, as may box and counts, which a state of the caller says.
/// Throws InputError.
Scene parse_recorded_scene(const std::string& text, std::string_view name);

/// Replaces conditions of [until] in a scene that has been read, by overrides "until.key=value",
/// and removes those that are "until.key=none". Throws InputError for other keys, for bad values
/// and for ends that the scene cannot have.
void override_until(Scene& scene, std::span<const std::string> overrides);

/// The text of a scene file, or its first part if it is longer than max_scene_bytes, which
/// parse_scene then rejects. Throws IoError if it cannot be read.
std::string read_scene_text(const std::string& path);

/// Reads and parses a scene file. Throws IoError if it cannot be read.
Scene read_scene(const std::string& path, std::span<const std::string> overrides = {},
                 Provided provided = {});

}  // namespace needlework
