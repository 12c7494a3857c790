#include "needlework/parse.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "src/composition/pair_name.h"
#include "src/scene/bodies.h"
#include "src/scene/box_edges.h"
#include "src/scene/confinement.h"
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

// Sections that occur several times, each time with a name by which overrides mean it: that of a
// species, "a-b" for a pair, "z-low" for a wall.
bool may_occur_again(std::string_view section) {
  return section == "species" || section == "pairs" || section == "walls";
}

// Whether a value of the key is part of that name.
bool names_item(const Entry& entry) {
  const std::string name = full_name(entry);
  return name == "species.name" || name == "pairs.between" || name == "walls.axis" ||
         name == "walls.side";
}

// The same for keys of different occurrences only if they are of the first.
std::string own_name(const Entry& entry) {
  const std::string name = full_name(entry);
  return entry.number == 0 ? name : fmt::format("{}#{}", name, entry.number);
}

std::string item_of(const Entry& entry) {
  if (const auto* name = entry.value.as<std::string>()) return *name;
  std::vector<std::string> names;
  if (const auto* array = entry.value.as<Value::Array>()) {
    for (const Value& element : *array) {
      if (const auto* name = element.as<std::string>()) names.push_back(*name);
    }
  }
  return fmt::format("{}", fmt::join(names, "-"));
}

// Appends it to what other keys of the same occurrence have given; the axis of a wall is first.
void add_to_name(std::string& name, const Entry& entry) {
  const std::string item = item_of(entry);
  name = name.empty() ? item : entry.key == "axis" ? item + "-" + name : name + "-" + item;
}

// Finds out which occurrence of a section each override is for.
std::vector<Entry> with_items_found(const Document& document) {
  std::map<std::string, std::vector<std::string>> items;
  std::vector<Entry> out = document.entries();
  for (Entry& entry : out) {
    if (!entry.is_override) {
      if (!may_occur_again(entry.section)) continue;
      auto& names = items[entry.section];
      if (entry.is_head) names.emplace_back();
      if (names_item(entry) && !names.empty()) add_to_name(names.back(), entry);
      continue;
    }
    if (!may_occur_again(entry.section)) {
      if (!entry.item.empty()) throw document.error(entry, "expected section.key=value");
      continue;
    }
    const std::vector<std::string>& names = items[entry.section];
    if (names.empty())
      throw document.error(entry,
                           fmt::format("expected a scene with an entry [[{}]]", entry.section));
    if (entry.item.empty() && names.size() == 1) continue;
    const auto found = std::find(names.begin(), names.end(), entry.item);
    if (found == names.end()) {
      throw document.error(entry, fmt::format("expected {0}.NAME.{1} with one of the names {2}",
                                              entry.section, entry.key, fmt::join(names, ", ")));
    }
    entry.number = static_cast<std::size_t>(found - names.begin());
  }
  return out;
}

// Keys of which a scene has one, as both would say the same thing.
constexpr std::pair<const char*, const char*> alternatives[] = {
    {"collisions.tc", "collisions.tc_relative"},
    {"output.series_per_decade", "output.series_every"},
    {"output.frames", "output.frames_every"}};

// The alternative to a key; "" if it has none.
std::string_view alternative_to(std::string_view name) {
  for (const auto& [one, other] : alternatives) {
    if (name == one) return other;
    if (name == other) return one;
  }
  return "";
}

// Whether an override replaces an earlier entry: one of the same key, or the alternative in the
// file (see parse_scene).
bool replaces(const Entry& override_entry, const Entry& entry) {
  if (entry.is_head) return false;
  const std::string name = full_name(entry), override_name = full_name(override_entry);
  if (name == override_name) return entry.number == override_entry.number;
  if (entry.is_override) return false;
  if (name == alternative_to(override_name)) return true;
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
      std::erase_if(result, [&](const Entry& e) { return replaces(entry, e); });
    if (!removes_end(entry)) result.push_back(entry);
  }
  return result;
}

// Begins an entry [[species]], [[pairs]] or [[walls]].
void begin_again(Scene& scene, const Document& document, const Entry& head) {
  if (!head.is_repeated)
    throw document.error(head, fmt::format("expected [[{}]], in double brackets", head.section));
  const auto begin = [&](auto& all, std::size_t most) {
    if (all.size() == most)
      throw document.error(head, fmt::format("expected at most {} entries", most));
    all.emplace_back();
  };
  if (head.section == "species") begin(scene.species, most_species);
  if (head.section == "pairs") begin(scene.pairs, most_species * (most_species + 1) / 2);
  if (head.section == "walls") begin(scene.walls, most_walls);
}

// Reads the value of a key. Keys of sections that occur again are read into the last of them.
bool read_value(Scene& scene, const SceneKey& key, const Entry& entry) {
  const auto into = [&](auto& all) {
    std::swap(all[entry.number], all.back());
    const bool read = key.read(scene, entry.value);
    std::swap(all[entry.number], all.back());
    return read;
  };
  if (entry.section == "species") return into(scene.species);
  if (entry.section == "pairs") return into(scene.pairs);
  if (entry.section == "walls") return into(scene.walls);
  return key.read(scene, entry.value);
}

// k of rods follows from their shape, where neither it nor their inertia is given.
void adopt_shapes(Scene& scene, const std::set<std::string>& given) {
  if (!given.contains("needles.k") && scene.needles.diameter > 0)
    scene.needles.k = homogeneous_k(1, scene.needles.diameter);
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    Species& species = scene.species[n];
    const bool is_rod = species.diameter > 0 && species.turns();
    if (is_rod && !given.contains(key_of_species("k", n)) && !species.given_inertia)
      species.k = homogeneous_k(species.length, species.diameter);
  }
}

// Writes what the species say in the form that all readers of scenes know: k instead of the moment
// of inertia, and how many needles there are in all.
void adopt_species(Scene& scene, bool is_drawn) {
  if (scene.species.empty()) return;
  const Composition composition = scene.composition();
  for (std::size_t n = 0; is_drawn && n < composition.size(); ++n) {
    scene.species[n].k = composition[n].k;
    scene.species[n].given_inertia.reset();
  }
  // A file may tell counts that are left out.
  const bool all_given =
      scene.initial.file.empty() || !composition.is_mixture() ||
      std::ranges::all_of(scene.species, [](const Species& s) { return s.count > 0; });
  scene.needles.count = all_given ? composition.count() : 0;
  const auto place = scene.places.find("species.count");
  if (place != scene.places.end()) scene.places.emplace("needles.count", place->second);
}

// Whether a key describes the initial state, apart from count and box.
bool describes_state(const std::string& name) {
  return name == "initial.file" || name == "initial.t_tr" || name == "initial.t_rot" ||
         name == "species.t_tr" || name == "species.t_rot";
}

// The requirement that a key violates because of what the caller provides or because an earlier
// key excludes it; empty if there is none.
std::string conflict(const std::string& name, const std::set<std::string>& given,
                     Provided provided) {
  if (provided.state && describes_state(name)) return "expected none, as the state is given apart";
  const auto has = [&](const char* other) { return given.contains(other); };
  for (const auto& [one, other] : alternatives) {
    if ((name == one && has(other)) || (name == other && has(one))) {
      const auto key_of = [](std::string_view full) { return full.substr(full.find('.') + 1); };
      return fmt::format("expected either {} or {}, not both", key_of(one), key_of(other));
    }
  }
  if ((name == "initial.file" && (has("initial.t_tr") || has("initial.t_rot"))) ||
      ((name == "initial.t_tr" || name == "initial.t_rot") && has("initial.file")))
    return "expected either file or temperatures to draw, not both";
  const bool of_species = name.starts_with("species.");
  for (const char* key :
       {"needles.count", "needles.k", "needles.diameter", "initial.t_tr", "initial.t_rot"}) {
    const bool species_given =
        std::any_of(given.begin(), given.end(),
                    [](const std::string& other) { return other.starts_with("species."); });
    if ((of_species && has(key)) || (name == key && species_given))
      return "expected either [[species]] or needles.count, needles.k, needles.diameter and the "
             "temperatures of [initial], not both";
  }
  if (((name == "species.t_tr" || name == "species.t_rot") && has("initial.file")) ||
      (name == "initial.file" && (has("species.t_tr") || has("species.t_rot"))))
    return "expected either file or temperatures to draw, not both";
  return {};
}

void require_what_is_needed(const Scene& scene, const Document& document,
                            const std::set<std::string>& given, Provided provided) {
  const bool has_state = provided.state || !scene.initial.file.empty();
  const auto require = [&](const char* section, const char* key, std::size_t number) {
    Entry entry;
    entry.section = section;
    entry.key = key;
    entry.number = number;
    if (given.contains(own_name(entry))) return;
    const std::string which = number == 0 ? "" : fmt::format(" of the entry {}", number + 1);
    throw document.missing(full_name(entry) + which,
                           fmt::format("expected {}", find_scene_key(section, key)->expected));
  };
  if (!has_state) {
    if (scene.species.empty()) require("needles", "count", 0);
    for (std::size_t n = 0; n < scene.species.size(); ++n) require("species", "count", n);
    require("needles", "box", 0);
  }
  for (std::size_t n = 0; n < scene.species.size(); ++n) require("species", "name", n);
  for (std::size_t n = 0; n < scene.pairs.size(); ++n) require("pairs", "between", n);
  for (std::size_t n = 0; n < scene.walls.size(); ++n) {
    require("walls", "axis", n);
    require("walls", "side", n);
    if (!scene.walls[n].motion) continue;
    require("walls", "motion.amplitude", n);
    require("walls", "motion.frequency", n);
  }
  if (scene.driving.kicks) require("driving", "kicks.every", 0);
  if (scene.driving.andersen) {
    require("driving", "andersen.rate", 0);
    require("driving", "andersen.temperature", 0);
  }
  const Scene::Until& until = scene.until;
  if (provided.end) return;
  if (!until.time && !until.collisions_per_needle && !until.energy_ratio && !until.wall_s)
    throw document.missing("an end condition in [until]",
                           "expected one or more of time, collisions_per_needle, energy_ratio, "
                           "wall_s");
}

// What is told of each two species names them "a-b", which must not stand for two pairs.
void require_names_of_pairs(const Scene& scene, const Document& document,
                            std::span<const Entry> entries) {
  const Composition composition = scene.composition();
  std::set<std::string> pairs;
  for (const Entry& entry : entries) {
    if (entry.section != "species") continue;
    for (std::size_t other = 0; other <= entry.number; ++other) {
      std::string name = pair_name(composition, other, entry.number);
      if (pairs.insert(name).second) continue;
      throw document.error(
          entry, fmt::format("expected a name with which only one pair of species is called {}",
                             printable(name, 200)));
    }
  }
}

// Species have different names, and pairs the names of species, each pair once.
void require_names(const Scene& scene, const Document& document, std::span<const Entry> entries) {
  const auto same_pair = [](const Scene::Pair& a, const Scene::Pair& b) {
    return a.between == b.between || (a.between[0] == b.between[1] && a.between[1] == b.between[0]);
  };
  for (std::size_t n = 0; n < entries.size(); ++n) {
    if (entries[n].section != "species") continue;
    for (const Entry& before : entries.first(n)) {
      if (before.section != "species") continue;
      if (scene.species[before.number].name == scene.species[entries[n].number].name)
        throw document.error(entries[n], "expected a name that no other species has");
    }
  }
  require_names_of_pairs(scene, document, entries);
  for (const Entry& entry : entries) {
    if (full_name(entry) != "pairs.between") continue;
    const Scene::Pair& pair = scene.pairs[entry.number];
    for (std::size_t n = 0; n < entry.number; ++n) {
      if (same_pair(scene.pairs[n], pair))
        throw document.error(entry, "expected each two species once");
    }
  }
}

// All species together have as many needles as there are ids.
void require_ids(const Scene& scene, const Document& document, const Entry& last_count) {
  const std::uint64_t count = scene.composition().count();
  if (count <= most_needles) return;
  throw document.error(last_count, fmt::format("expected at most {} needles of all species, not {}",
                                               most_needles, count));
}

// For a state that is drawn: what follows from its numbers.
void require_followable(const Scene& scene, std::string_view name) {
  const Composition composition = scene.composition();
  if (is_too_sparse(scene.needles.box, static_cast<double>(composition.count()),
                    composition.longest())) {
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
  std::set<std::string> given;       // own names, so that each entry of a list has its keys
  std::set<std::string> given_keys;  // those of all entries of a list alike
  Entry last_count;
  std::vector<Entry> names;
  for (const Entry& entry : with_overrides_applied(with_items_found(document))) {
    if (entry.is_head) {
      if (!is_scene_section(entry.section)) throw document.error(entry, expected_instead(entry));
      if (may_occur_again(entry.section))
        begin_again(scene, document, entry);
      else if (entry.is_repeated)
        throw document.error(entry, fmt::format("expected [{}], once", entry.section));
      continue;
    }
    const SceneKey* key = find_scene_key(entry.section, entry.key);
    if (!key) throw document.error(entry, expected_instead(entry));
    if (may_occur_again(entry.section) && !entry.is_repeated && !entry.is_override)
      throw document.error(entry,
                           fmt::format("expected a scene with an entry [[{}]]", entry.section));
    if (full_name(entry) == "species.count") last_count = entry;
    if (full_name(entry) == "species.name" || entry.section == "pairs") names.push_back(entry);
    if (!read_value(scene, *key, entry))
      throw document.error(entry, key->expected_instead_of(entry.value));
    if (const std::string reason = conflict(full_name(entry), given_keys, provided);
        !reason.empty())
      throw document.error(entry, reason);
    given_keys.insert(full_name(entry));
    given.insert(own_name(entry));
    scene.places[own_name(entry)] = document.place(entry);
  }
  require_names(scene, document, names);
  require_ids(scene, document, last_count);
  adopt_shapes(scene, given);
  // A state that is given may say what the scene does not: see adopt_state().
  const bool is_drawn = !provided.state && scene.initial.file.empty();
  if (is_drawn) require_possible_bodies(scene);
  // Where there are walls, the room depends on what they need.
  const bool box_given = given.contains("needles.box"), walled = !scene.walls.empty();
  if (is_drawn && box_given && !walled) require_room_in_box(scene);
  require_what_is_needed(scene, document, given, provided);
  if (is_drawn || !scene.species.empty()) require_pairs_of_species(scene);
  require_compatible_effects(scene);
  require_walls_to_observe(scene);
  if (is_drawn && box_given && walled) require_room_in_box(scene);
  adopt_species(scene, is_drawn);
  if (is_drawn) require_followable(scene, name);
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

// Those of the last lines alone: a comment of the author further up sets nothing.
std::vector<std::string> recorded_overrides(const std::string& text) {
  constexpr std::string_view mark = "# --set ";
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(mark)) {
      overrides.push_back(line.substr(mark.size()));
    } else {
      overrides.clear();
    }
  }
  return overrides;
}

}  // namespace

Scene parse_recorded_scene(const std::string& text, std::string_view name) {
  return parse_scene(text, name, recorded_overrides(text), {.end = true});
}

void override_until(Scene& scene, std::span<const std::string> overrides) {
  const std::vector<Override> set = of_options(overrides);
  const Document document("", "", set);
  for (const Entry& entry : document.entries()) {
    const SceneKey* key = find_scene_key(entry.section, entry.key);
    if (!key) throw document.error(entry, expected_instead(entry));
    if (entry.section != "until" || !entry.item.empty())
      throw document.error(
          entry,
          "expected a key of [until], as the rest of the scene is given; a new "
          "scene with initial.file goes on from the state of a file by other rules");
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
