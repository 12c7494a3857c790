#include "src/scene/validity.h"

#include <fmt/format.h>

#include <algorithm>

#include "needlework/error.h"
#include "src/scene/printable.h"
#include "src/scene/scene_values.h"
#include "src/scene/schema.h"

namespace needlework {
namespace {

// The key that a message names: of several at fault, the one that was given last.
const std::string& key_at_fault(const Violation& violation, std::span<const std::string> given) {
  const auto place = [&](const std::string& key) {
    return std::ranges::find(given, key) - given.begin();
  };
  const auto is_known = [&](const std::string& key) {
    return place(key) < static_cast<std::ptrdiff_t>(given.size());
  };
  const std::string* last = &violation.key;
  for (const std::string& key : violation.or_keys) {
    if (is_known(key) && (!is_known(*last) || place(key) > place(*last))) last = &key;
  }
  return *last;
}

// The place where the key was given; of a scene made in code, "the scene: KEY = VALUE".
std::string place_of(const Violation& violation, const Scene& scene, const SceneOrigin& origin) {
  if (violation.key.empty()) return printable(origin.name);
  const std::string& key = key_at_fault(violation, origin.given);
  const auto found = scene.places.find(key);
  if (origin.has_places && found != scene.places.end()) return found->second;
  // Of a key that occurs several times, the number of the entry is not for messages.
  const std::string name = violation.key.substr(0, violation.key.find('#'));
  const bool is_of_code = scene.places.empty() || !origin.has_places;
  return fmt::format("{}{}{}{}", is_of_code ? "the scene: " : "", name,
                     violation.value.empty() ? "" : " = ", violation.value);
}

void require_few_entries(const Scene& scene) {
  for (const SceneSection& section : scene_schema()) {
    const std::size_t most = section.entries.most;
    if (most == 0 || section.entries.count(scene) <= most) continue;
    throw InputError(
        fmt::format("the scene: [[{}]]: expected at most {} entries", section.name, most));
  }
}

}  // namespace

void require_ranges(const Scene& scene, Aspects aspects) {
  require_few_entries(scene);
  Scene again = scene;
  have_entries(again);
  for (const auto& [section, name, value] : values_of(scene)) {
    const SceneKey* key = find_scene_key(section, name);
    if (!aspects.has(key->aspect)) continue;
    if (!scene.species.empty() && !aspects.has(Aspect::restored) && is_replaced_by_species(*key))
      continue;
    if (key->read(again, value)) continue;
    throw InputError(fmt::format("the scene: {}{}{} = {}: {}", section, section.empty() ? "" : ".",
                                 name, in_quotes(value), key->expected_instead_of(value)));
  }
}

void require_rules(const Scene& scene, Aspects aspects, const SceneOrigin& origin) {
  for (const SceneRule& rule : scene_rules()) {
    if (!aspects.has(rule.aspect)) continue;
    if (const auto violation = rule.violation(scene)) {
      throw InputError(
          fmt::format("{}: {}", place_of(*violation, scene, origin), violation->reason));
    }
  }
}

void require_valid(const Scene& scene, Aspects aspects) {
  require_ranges(scene, aspects);
  require_rules(scene, aspects);
}

void require_restored(const Scene& scene) {
  require_ranges(scene, Aspect::bodies | Aspect::walls | Aspect::effects | Aspect::output |
                            Aspect::start | Aspect::restored);
  require_rules(scene,
                Aspect::species | Aspect::bodies | Aspect::pairs | Aspect::walls | Aspect::effects |
                    Aspect::output | Aspect::room | Aspect::restored | Aspect::sizes,
                {.has_places = false});
}

}  // namespace needlework
