#include "src/scene/schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"
#include "src/scene/suggest.h"

namespace needlework {
namespace {

std::optional<Violation> text_is_too_long(const Scene& scene) {
  if (scene.text.size() <= max_scene_bytes) return {};
  return Violation{.key = "text", .value = {}, .reason = "expected at most 1 MiB"};
}

SceneSection title() {
  return {.name = "",
          .keys = {{"title",
                    Aspect::output,
                    {},
                    "a string without control characters",
                    [](Scene& s, const Value& v, const ValueRange&) {
                      return from_value::store(s.title, from_value::text(v));
                    }}},
          .rules = {{Aspect::restored, text_is_too_long}}};
}

struct Schema {
  // In the order of their documentation, in which messages list them. This is the list of all that
  // a scene may say.
  std::vector<SceneSection> sections = {title(),           needles_section(),    species_section(),
                                        initial_section(), collisions_section(), pairs_section(),
                                        walls_section(),   forces_section(),     shear_section(),
                                        driving_section(), engine_section(),     until_section(),
                                        output_section()};
  std::vector<std::string_view> names;
  std::vector<SceneKey> keys;
  std::vector<SceneRule> rules;
  std::vector<Exclusion> exclusions;

  Schema() {
    for (SceneSection& section : sections) {
      if (!section.name.empty()) names.push_back(section.name);
      for (SceneKey& key : section.keys) key.section = section.name;
      keys.insert(keys.end(), section.keys.begin(), section.keys.end());
      rules.insert(rules.end(), section.rules.begin(), section.rules.end());
      exclusions.insert(exclusions.end(), section.exclusions.begin(), section.exclusions.end());
    }
    std::ranges::stable_sort(rules, {}, &SceneRule::aspect);
  }
};

const Schema& schema() {
  static const Schema all;
  return all;
}

std::vector<std::string_view> keys_of(std::string_view section) {
  std::vector<std::string_view> names;
  for (const SceneKey& k : scene_keys())
    if (k.section == section) names.push_back(k.key);
  return names;
}

// Whether a word is one of the parts of a key, as "collisions" is of collisions_per_needle.
bool has_part(std::string_view key, std::string_view word) {
  while (!key.empty()) {
    const std::size_t end = std::min(key.find_first_of("_."), key.size());
    if (end == word.size() && edit_distance(key.substr(0, end), word) == 0) return true;
    key.remove_prefix(std::min(end + 1, key.size()));
  }
  return false;
}

// The key of a section that is most similar to an unknown one, or else those of which it is a part.
std::vector<std::string_view> meant_keys(std::string_view unknown,
                                         const std::vector<std::string_view>& known) {
  if (const auto nearest = nearest_word(unknown, known); !nearest.empty()) return {nearest};
  std::vector<std::string_view> out;
  std::ranges::copy_if(known, std::back_inserter(out),
                       [&](std::string_view key) { return has_part(key, unknown); });
  return out;
}

std::string expected_instead_of_section(std::string_view name) {
  const std::string_view nearest = nearest_word(name, scene_sections());
  return fmt::format("expected one of the sections {}{}", fmt::join(scene_sections(), ", "),
                     did_you_mean(nearest));
}

}  // namespace

std::span<const SceneSection> scene_schema() { return schema().sections; }
std::span<const SceneKey> scene_keys() { return schema().keys; }
std::span<const SceneRule> scene_rules() { return schema().rules; }
std::span<const Exclusion> scene_exclusions() { return schema().exclusions; }
std::span<const std::string_view> scene_sections() { return schema().names; }

const SceneKey* find_scene_key(std::string_view section, std::string_view key) {
  const auto keys = scene_keys();
  const auto found = std::ranges::find_if(
      keys, [&](const SceneKey& k) { return k.section == section && k.key == key; });
  return found == keys.end() ? nullptr : &*found;
}

const SceneSection* find_scene_section(std::string_view name) {
  const auto sections = scene_schema();
  const auto found = std::ranges::find(sections, name, &SceneSection::name);
  return found == sections.end() ? nullptr : &*found;
}

bool is_scene_section(std::string_view section) {
  return !section.empty() && find_scene_section(section);
}

bool is_scene_table(std::string_view section, std::string_view key) {
  return std::ranges::any_of(scene_keys(), [&](const SceneKey& k) {
    return k.section == section && k.key.size() > key.size() && k.key.starts_with(key) &&
           k.key[key.size()] == '.';
  });
}

bool is_replaced_by_species(const SceneKey& key) {
  const std::string name = fmt::format("{}.{}", key.section, key.key);
  return std::ranges::any_of(scene_exclusions(), [&](const Exclusion& each) {
    return each.one == "species." && each.other == name;
  });
}

void have_entries(Scene& scene) {
  for (const SceneSection& section : scene_schema())
    if (section.is_repeated() && section.entries.count(scene) == 0) section.entries.append(scene);
}

bool accepts(const SceneKey& key, const Value& value) {
  Scene scene;
  have_entries(scene);
  return key.read(scene, value);
}

std::string expected_instead(const Entry& unknown) {
  if (is_scene_table(unknown.section, unknown.key)) {
    std::vector<std::string_view> inner;
    for (const std::string_view name : keys_of(unknown.section)) {
      if (name.starts_with(unknown.key + ".")) inner.push_back(name.substr(unknown.key.size() + 1));
    }
    return fmt::format("expected {{{} = ...}}", fmt::join(inner, " = ..., "));
  }
  if (unknown.section.empty() && is_scene_section(unknown.key))
    return fmt::format("expected a section [{}]", unknown.key);
  if (!unknown.section.empty() && !is_scene_section(unknown.section))
    return expected_instead_of_section(unknown.section);
  const std::vector<std::string_view> names = keys_of(unknown.section);
  const std::vector<std::string_view> meant = meant_keys(unknown.key, names);
  const bool may_be_table = std::holds_alternative<std::monostate>(unknown.value.data);
  if (is_scene_section(unknown.key) && (may_be_table || meant.empty())) {
    return fmt::format(
        "expected [{0}] as a section of its own, or {0}.KEY above the first [section]",
        unknown.key);
  }
  std::vector<std::string_view> shown;  // without keys of tables in place of which a number may be
  for (const std::string_view name : names) {
    const std::string_view table = name.substr(0, name.find('.'));
    if (table == name || !find_scene_key(unknown.section, table)) shown.push_back(name);
  }
  std::string suggestion = fmt::format("{}", fmt::join(meant, " or "));
  // If no key of the section is similar, looks for the same key in another section.
  for (const SceneKey& k : scene_keys()) {
    if (!meant.empty() || k.key != unknown.key) continue;
    suggestion += suggestion.empty() ? "" : " or ";
    suggestion += k.section.empty() ? k.key : fmt::format("{}.{}", k.section, k.key);
  }
  if (unknown.section.empty() && suggestion.empty())
    suggestion = nearest_word(unknown.key, scene_sections());
  return fmt::format("expected {}{}{}", unknown.section.empty() ? "a section or " : "one of ",
                     fmt::join(shown, ", "), did_you_mean(suggestion));
}

}  // namespace needlework
