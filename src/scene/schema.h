// The keys that a scene file may hold, and what each of them must be.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "needlework/scene.h"
#include "src/scene/document.h"

namespace needlework {

/// One key of a scene file.
struct SceneKey {
  std::string_view section;  ///< empty for a key outside all sections
  std::string_view key;
  std::string_view expected;  ///< what a value must be, for messages
  /// Puts the value into the scene; false, and the scene as it was, when it is not as expected.
  bool (*read)(Scene& scene, const Value& value);
};

/// All of them, in the order of their documentation.
std::span<const SceneKey> scene_keys();

/// The key of that name, or null.
const SceneKey* find_scene_key(std::string_view section, std::string_view key);

bool is_scene_section(std::string_view section);

/// All of them, in the order of their documentation.
std::span<const std::string_view> scene_sections();

/// What to expect instead of an unknown section, an unknown key, or a section that is no table:
/// "expected ..., did you mean ...?".
std::string expected_instead(const Entry& unknown);

}  // namespace needlework
