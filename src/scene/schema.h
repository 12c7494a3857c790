// The keys that a scene file may contain, and the requirements on their values.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "needlework/scene.h"
#include "src/scene/document.h"

namespace needlework {

/// A word that is not known, and the known one that is most similar, or empty.
struct UnknownWord {
  std::string word;
  std::string_view nearest;
};

/// One key of a scene file.
struct SceneKey {
  std::string_view section;  ///< empty for a key outside all sections
  std::string_view key;
  std::string_view expected;  ///< the requirement on the value, for messages
  /// Stores the value in the scene. Returns false, and leaves the scene unchanged, if the value
  /// does not meet the requirement.
  bool (*read)(Scene& scene, const Value& value);
  /// What is wrong with a value that was refused, if more can be said than the requirement: the
  /// word in it that is not known.
  std::optional<UnknownWord> (*unknown_word)(const Value& value) = nullptr;

  /// For the message about a value that was refused: "expected ...".
  std::string expected_instead_of(const Value& value) const;
};

/// All keys, in the order of their documentation.
std::span<const SceneKey> scene_keys();

/// The key of that name, or null if there is none.
const SceneKey* find_scene_key(std::string_view section, std::string_view key);

bool is_scene_section(std::string_view section);

/// Whether keys of the section begin with "KEY.", which a scene file may write as a table, such as
/// `kicks = { every = 1 }`.
bool is_scene_table(std::string_view section, std::string_view key);

/// Limit of the number of entries [[walls]]: one at each side of the box.
inline constexpr std::size_t most_walls = 6;

/// Whether the value meets the requirement of the key.
bool accepts(const SceneKey& key, const Value& value);

/// All sections, in the order of their documentation.
std::span<const std::string_view> scene_sections();

/// What to expect instead of an unknown section, an unknown key, or a section that is not a table:
/// "expected ..., did you mean ...?".
std::string expected_instead(const Entry& unknown);

}  // namespace needlework
