#include "needlework/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "src/scene/box_edges.h"
#include "src/scene/derived_numbers.h"
#include "src/scene/document.h"
#include "src/scene/overridden_scene.h"
#include "src/scene/printable.h"
#include "src/scene/schema.h"
#include "src/scene/text_input.h"

namespace needlework {
namespace {

std::string full_name(const Entry& entry) {
  return entry.section.empty() ? entry.key : entry.section + "." + entry.key;
}

// Whether an override replaces an earlier entry: one of the same key, or the alternative in the
// file (see parse_scene).
bool replaces(const std::string& override_name, const Entry& entry) {
  if (entry.is_head) return false;
  const std::string name = full_name(entry);
  if (name == override_name) return true;
  if (entry.is_override) return false;
  if (override_name == "collisions.tc") return name == "collisions.tc_relative";
  if (override_name == "collisions.tc_relative") return name == "collisions.tc";
  if (override_name == "output.series_every") return name == "output.series_per_decade";
  if (override_name == "output.series_per_decade") return name == "output.series_every";
  if (override_name == "initial.file") {
    return name == "initial.t_tr" || name == "initial.t_rot" || name == "species.t_tr" ||
           name == "species.t_rot";
  }
  return false;
}

bool is_none(const Value& value) {
  const auto* text = value.as<std::string>();
  return text && *text == "none";
}

bool removes_end(const Entry& entry) {
  return entry.is_override && entry.section == "until" && is_none(entry.value) &&
         find_scene_key(entry.section, entry.key);
}

std::vector<Entry> with_overrides_applied(const std::vector<Entry>& entries) {
  std::vector<Entry> result;
  for (const Entry& entry : entries) {
    if (entry.is_override)
      std::erase_if(result,
                    [name = full_name(entry)](const Entry& e) { return replaces(name, e); });
    if (!removes_end(entry)) result.push_back(entry);
  }
  return result;
}

constexpr const char* one_species =
    "expected one [[species]] entry: gases of several species are not simulated yet";

// Begins an entry [[species]].
void begin_species(Scene& scene, const Document& document, const Entry& head) {
  if (!head.is_repeated) throw document.error(head, "expected [[species]], in double brackets");
  if (!scene.species.empty()) throw document.error(head, one_species);
  scene.species.emplace_back();
}

// Sets the keys of [needles] and [initial] that the species replaces.
void adopt_species(Scene& scene) {
  if (scene.species.empty()) return;
  const Scene::Species& species = scene.species.front();
  scene.needles.count = species.count;
  scene.needles.k = species.k;
  scene.initial.t_tr = species.t_tr;
  scene.initial.t_rot = species.t_rot;
  for (const auto& [from, to] :
       {std::pair("species.count", "needles.count"), std::pair("species.k", "needles.k")}) {
    const auto place = scene.places.find(from);
    if (place != scene.places.end()) scene.places.emplace(to, place->second);
  }
}

// Whether a key describes the initial state, apart from count and box.
bool describes_state(const std::string& name) {
  return name == "initial.file" || name == "initial.t_tr" || name == "initial.t_rot" ||
         name == "species.t_tr" || name == "species.t_rot";
}

// The requirement that a key violates because of what the caller provides or because an earlier
// key excludes it; empty if there is none.
std::string_view conflict(const std::string& name, const std::set<std::string>& given,
                          Provided provided) {
  if (provided.state && describes_state(name)) return "expected none, as the state is given apart";
  const auto has = [&](const char* other) { return given.contains(other); };
  if ((name == "collisions.tc" && has("collisions.tc_relative")) ||
      (name == "collisions.tc_relative" && has("collisions.tc")))
    return "expected either tc or tc_relative, not both";
  if ((name == "initial.file" && (has("initial.t_tr") || has("initial.t_rot"))) ||
      ((name == "initial.t_tr" || name == "initial.t_rot") && has("initial.file")))
    return "expected either file or temperatures to draw, not both";
  if ((name == "output.series_every" && has("output.series_per_decade")) ||
      (name == "output.series_per_decade" && has("output.series_every")))
    return "expected either series_per_decade or series_every, not both";
  const bool of_species = name.starts_with("species.");
  for (const char* key : {"needles.count", "needles.k", "initial.t_tr", "initial.t_rot"}) {
    const bool species_given =
        std::any_of(given.begin(), given.end(),
                    [](const std::string& other) { return other.starts_with("species."); });
    if ((of_species && has(key)) || (name == key && species_given))
      return "expected either [[species]] or needles.count, needles.k and the temperatures of "
             "[initial], not both";
  }
  if (((name == "species.t_tr" || name == "species.t_rot") && has("initial.file")) ||
      (name == "initial.file" && (has("species.t_tr") || has("species.t_rot"))))
    return "expected either file or temperatures to draw, not both";
  return {};
}

void require_what_is_needed(const Scene& scene, const Document& document,
                            const std::set<std::string>& given, Provided provided) {
  const bool has_state = provided.state || !scene.initial.file.empty();
  const char* section = scene.species.empty() ? "needles" : "species";
  for (const auto& [where, key] : {std::pair(section, "count"), std::pair("needles", "box")}) {
    const std::string name = fmt::format("{}.{}", where, key);
    if (!given.contains(name) && !has_state)
      throw document.missing(name,
                             fmt::format("expected {}", find_scene_key(where, key)->expected));
  }
  if (!scene.species.empty() && !given.contains("species.name"))
    throw document.missing("species.name",
                           fmt::format("expected {}", find_scene_key("species", "name")->expected));
  const Scene::Until& until = scene.until;
  if (provided.end) return;
  if (!until.time && !until.collisions_per_needle && !until.energy_ratio && !until.wall_s)
    throw document.missing("an end condition in [until]",
                           "expected one or more of time, collisions_per_needle, energy_ratio, "
                           "wall_s");
}

void require_room(const Scene& scene, const Document& document, const Entry& box) {
  const double length = scene.species.empty() ? 1 : scene.species.front().length;
  if (has_room(scene.needles.box, length)) return;
  throw document.error(
      box, length == 1 ? fmt::format("expected {}", find_scene_key("needles", "box")->expected)
                       : "expected " + expected_room(scene.needles.box, length));
}

// For a state that is drawn: what follows from its numbers.
void require_followable(const Scene& scene, std::string_view name) {
  const Scene::Species species = scene.one_species();
  if (is_too_sparse(scene.needles.box, static_cast<double>(species.count), species.length)) {
    throw InputError(
        fmt::format("{}: expected {}", scene.places.at("needles.box"), not_too_sparse));
  }
  const std::string reason = out_of_range(numbers_of_drawn(scene));
  if (reason.empty()) return;
  throw InputError(
      fmt::format("{}: its needles and temperatures give {}", printable(name), reason));
}

// As --set gives them.
std::vector<Override> of_options(std::span<const std::string> assignments) {
  std::vector<Override> out;
  for (const std::string& assignment : assignments) out.push_back({assignment, {}});
  return out;
}

// The text as read, with overrides appended as comments.
std::string annotated(std::string_view text, std::span<const Override> overrides) {
  std::string result(text);
  if (!overrides.empty() && !result.empty() && result.back() != '\n') result += '\n';
  for (const Override& o : overrides) result += "# --set " + printable(o.assignment) + "\n";
  return result;
}

}  // namespace

Scene parse_scene(std::string_view text, std::string_view name,
                  std::span<const std::string> overrides, Provided provided) {
  return parse_overridden_scene(text, name, of_options(overrides), provided);
}

Scene parse_overridden_scene(std::string_view text, std::string_view name,
                             std::span<const Override> overrides, Provided provided) {
  if (text.size() > max_scene_bytes)
    throw InputError(fmt::format("{}: too large: expected a scene of at most {} bytes",
                                 printable(name), max_scene_bytes));
  const Document document(text, name, overrides);
  Scene scene;
  std::set<std::string> given;
  Entry box;
  for (const Entry& entry : with_overrides_applied(document.entries())) {
    if (entry.is_head) {
      if (!is_scene_section(entry.section)) throw document.error(entry, expected_instead(entry));
      if (entry.section == "species")
        begin_species(scene, document, entry);
      else if (entry.is_repeated)
        throw document.error(entry, fmt::format("expected [{}], once", entry.section));
      continue;
    }
    const SceneKey* key = find_scene_key(entry.section, entry.key);
    if (!key) throw document.error(entry, expected_instead(entry));
    if (entry.section == "species" && scene.species.empty())
      throw document.error(entry, "expected a scene with an entry [[species]]");
    if (full_name(entry) == "needles.box") box = entry;
    if (!key->read(scene, entry.value))
      throw document.error(entry, key->expected_instead_of(entry.value));
    if (const std::string_view reason = conflict(full_name(entry), given, provided);
        !reason.empty())
      throw document.error(entry, reason);
    given.insert(full_name(entry));
    scene.places[full_name(entry)] = document.place(entry);
  }
  if (given.contains("needles.box")) require_room(scene, document, box);
  require_what_is_needed(scene, document, given, provided);
  adopt_species(scene);
  if (!provided.state && scene.initial.file.empty()) require_followable(scene, name);
  scene.text = annotated(text, overrides);
  return scene;
}

namespace {

void remove_end(Scene::Until& until, std::string_view key) {
  auto& [time, collisions_per_needle, energy_ratio, wall_s] = until;
  for (const auto& [name, end] :
       {std::pair<std::string_view, std::optional<double>*>{"time", &time},
        {"collisions_per_needle", &collisions_per_needle},
        {"energy_ratio", &energy_ratio},
        {"wall_s", &wall_s}}) {
    if (name == key) end->reset();
  }
}

}  // namespace

void override_until(Scene& scene, std::span<const std::string> overrides) {
  const std::vector<Override> set = of_options(overrides);
  const Document document("", "", set);
  for (const Entry& entry : document.entries()) {
    const SceneKey* key = find_scene_key(entry.section, entry.key);
    if (!key) throw document.error(entry, expected_instead(entry));
    if (entry.section != "until")
      throw document.error(entry, "expected a key of [until], as the rest of the scene is given");
    if (removes_end(entry)) {
      remove_end(scene.until, entry.key);
    } else if (!key->read(scene, entry.value)) {
      throw document.error(entry, fmt::format("expected {}, or none to remove it", key->expected));
    }
    scene.places[full_name(entry)] = document.place(entry);
  }
}

std::string read_scene_text(const std::string& path) {
  const auto file = open_text(path);
  // One byte more than allowed shows that the text is too long.
  std::string text(max_scene_bytes + 1, '\0');
  errno = 0;
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (std::ferror(file.get())) {
    throw IoError(fmt::format("{}: cannot be read: {}", printable(path),
                              std::generic_category().message(errno)));
  }
  return text;
}

Scene read_scene(const std::string& path, std::span<const std::string> overrides,
                 Provided provided) {
  return parse_scene(read_scene_text(path), path, overrides, provided);
}

}  // namespace needlework
