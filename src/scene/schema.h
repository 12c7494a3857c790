// What a scene may say: all sections, with their keys and rules.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "src/scene/section.h"

namespace needlework {

/// All sections, keys and exclusions, in the order of their documentation; the first section, of
/// what is outside of all others, has no name. Rules come in the order in which they are asked:
/// what a rule builds on is asked first.
std::span<const SceneSection> scene_schema();
std::span<const SceneKey> scene_keys();
std::span<const SceneRule> scene_rules();
std::span<const Exclusion> scene_exclusions();
/// The names of all sections but the first.
std::span<const std::string_view> scene_sections();

/// The key, or the section, of that name; null if there is none.
const SceneKey* find_scene_key(std::string_view section, std::string_view key);
const SceneSection* find_scene_section(std::string_view name);

bool is_scene_section(std::string_view section);

/// Whether keys of the section begin with "KEY.", which a scene file may write as a table, such as
/// `kicks = { every = 1 }`.
bool is_scene_table(std::string_view section, std::string_view key);

/// Whether a scene with entries [[species]] says this key of each of them instead.
bool is_replaced_by_species(const SceneKey& key);

/// Gives each section that occurs several times one entry at least, so that its keys can be read.
void have_entries(Scene& scene);

/// Whether the value meets the requirement of the key.
bool accepts(const SceneKey& key, const Value& value);

/// What to expect instead of an unknown section, an unknown key, or a section that is not a table:
/// "expected ..., did you mean ...?".
std::string expected_instead(const Entry& unknown);

}  // namespace needlework
