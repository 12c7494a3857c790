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
#include "src/scene/confinement.h"
#include "src/scene/needed_memory.h"
#include "src/scene/printable.h"
#include "src/scene/schema.h"
#include "src/scene/validity.h"
#include "src/scene_text/document.h"
#include "src/scene_text/overridden_scene.h"
#include "src/scene_text/text_input.h"

namespace needlework {
namespace {

std::string full_name(const Entry& entry) {
  return entry.section.empty() ? entry.key : entry.section + "." + entry.key;
}

// Sections that occur several times, each time with a name by which overrides mean it: that of a
// species, "a-b" for a pair, "z-low" for a wall.
bool may_occur_again(std::string_view name) {
  const SceneSection* section = find_scene_section(name);
  return section && section->is_repeated();
}

// Whether a value of the key is part of that name.
bool names_item(const Entry& entry) {
  const std::string name = full_name(entry);
  return name == "species.name" || name == "pairs.between" || name == "walls.axis" ||
         name == "walls.side";
}

// The same for keys of different occurrences only if they are of the first.
std::string own_name(const Entry& entry) { return key_of_entry(full_name(entry), entry.number); }

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

// Whether a key is what an exclusion names: the key, or any one of a section.
bool is_named(std::string_view key, std::string_view name) {
  return name.ends_with('.') ? key.starts_with(name) : key == name;
}

// Whether an override replaces an earlier entry: one of the same key, or one in the file that the
// key excludes (see parse_scene).
bool replaces(const Entry& override_entry, const Entry& entry) {
  if (entry.is_head) return false;
  const std::string name = full_name(entry), override_name = full_name(override_entry);
  if (name == override_name) return entry.number == override_entry.number;
  if (entry.is_override) return false;
  if (entry.section == override_entry.section && entry.number != override_entry.number)
    return false;
  return std::ranges::any_of(scene_exclusions(), [&](const Exclusion& each) {
    if (each.replaces == Replaces::neither) return false;
    if (is_named(override_name, each.one) && is_named(name, each.other)) return true;
    return each.replaces == Replaces::each_the_other && is_named(override_name, each.other) &&
           is_named(name, each.one);
  });
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

// Begins an entry of a section that may occur again.
void begin_again(Scene& scene, const Document& document, const Entry& head) {
  if (!head.is_repeated)
    throw document.error(head, fmt::format("expected [[{}]], in double brackets", head.section));
  const Entries& entries = find_scene_section(head.section)->entries;
  if (entries.count(scene) == entries.most)
    throw document.error(head, fmt::format("expected at most {} entries", entries.most));
  entries.append(scene);
}

// Reads the value of a key. Keys of sections that occur again are read into the last of them.
bool read_value(Scene& scene, const SceneKey& key, const Entry& entry) {
  const SceneSection& section = *find_scene_section(entry.section);
  if (!section.is_repeated()) return key.read(scene, entry.value);
  section.entries.swap_with_last(scene, entry.number);
  const bool read = key.read(scene, entry.value);
  section.entries.swap_with_last(scene, entry.number);
  return read;
}

// k of rods follows from their shape, where neither it nor their inertia is given.
void adopt_shapes(Scene& scene, const std::set<std::string>& given) {
  if (!given.contains("needles.k") && scene.needles.diameter > 0)
    scene.needles.k = homogeneous_k(1, scene.needles.diameter);
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    Species& species = scene.species[n];
    const bool is_said = given.contains(key_of_entry("species.k", n)) || species.given_inertia ||
                         species.drawn.k || species.drawn.inertia;
    if (is_said) continue;
    species.drawn.homogeneous = species.drawn != DrawnSizes{};
    if (species.drawn.homogeneous) continue;
    if (species.diameter > 0 && species.has_axis())
      species.k = homogeneous_k(species.length, species.diameter);
  }
}

// How many needles there are in all.
void adopt_counts(Scene& scene) {
  if (scene.species.empty()) return;
  // A file may tell counts that are left out.
  const bool all_given =
      scene.initial.file.empty() || scene.species.size() == 1 ||
      std::ranges::all_of(scene.species, [](const Species& s) { return s.count > 0; });
  scene.needles.count = 0;
  for (const Species& each : scene.species) scene.needles.count += all_given ? each.count : 0;
  const auto place = scene.places.find("species.count");
  if (place != scene.places.end()) scene.places.emplace("needles.count", place->second);
}

// Writes what the species say in the form that all readers of scenes know: k instead of the moment
// of inertia.
void adopt_inertias(Scene& scene) {
  if (scene.species.empty()) return;
  const Composition composition = scene.composition();
  for (std::size_t n = 0; n < composition.size(); ++n) {
    if (composition[n].sizes) continue;        // each body has its own
    if (!composition[n].has_axis()) continue;  // whose inertia counts where they are rough
    scene.species[n].k = composition[n].k;
    scene.species[n].given_inertia.reset();
  }
}

// Whether a key describes the initial state, apart from count and box.
bool describes_state(const std::string& name) {
  return name == "initial.file" || name == "initial.t_tr" || name == "initial.t_rot" ||
         name == "species.t_tr" || name == "species.t_rot";
}

// The full names of keys by section, and by the occurrence of a section that occurs again.
using GivenKeys = std::map<std::pair<std::string, std::size_t>, std::set<std::string>>;

// The requirement that a key violates because of what the caller provides or because an earlier
// key excludes it, of the same entry where both are of entries; empty if there is none.
std::string_view conflict(const Entry& entry, const GivenKeys& given, Provided provided) {
  const std::string name = full_name(entry);
  if (provided.state && describes_state(name)) return "expected none, as the state is given apart";
  const auto is_given = [&](std::string_view key) {
    return std::ranges::any_of(given, [&](const auto& occurrence) {
      const auto& [section, number] = occurrence.first;
      if (section == entry.section && number != entry.number) return false;
      return std::ranges::any_of(occurrence.second,
                                 [&](const std::string& each) { return is_named(each, key); });
    });
  };
  for (const Exclusion& each : scene_exclusions()) {
    if ((is_named(name, each.one) && is_given(each.other)) ||
        (is_named(name, each.other) && is_given(each.one)))
      return each.expected;
  }
  return {};
}

// Whether an entry gives a key of the table that this key is of, and none of another form of it.
bool has_table(const SceneKey& key, std::size_t entry, const std::set<std::string>& given) {
  const std::string_view table = key.key.substr(0, key.key.find('.') + 1);
  const auto is_given = [&](std::string_view other) {
    return given.contains(key_of_entry(fmt::format("{}.{}", key.section, other), entry));
  };
  if (std::ranges::any_of(key.unless, is_given)) return false;
  return std::ranges::any_of(find_scene_section(key.section)->keys, [&](const SceneKey& other) {
    return other.key.starts_with(table) && is_given(other.key);
  });
}

void require_what_is_needed(const Scene& scene, const Document& document,
                            const std::set<std::string>& given, Provided provided) {
  const auto require = [&](const SceneKey& key, std::size_t entry) {
    const std::string name = fmt::format("{}.{}", key.section, key.key);
    if (given.contains(key_of_entry(name, entry))) return;
    const std::string which = entry == 0 ? "" : fmt::format(" of the entry {}", entry + 1);
    throw document.missing(name + which, fmt::format("expected {}", key.expected));
  };
  const auto entries_of = [&](const SceneSection& section) {
    return section.is_repeated() ? section.entries.count(scene) : 1;
  };
  if (!provided.state && scene.initial.file.empty()) {
    for (const std::string_view name : {"count", "box"}) {
      for (const SceneSection& section : scene_schema()) {
        for (const SceneKey& key : section.keys) {
          if (key.presence != Presence::to_draw || key.key != name) continue;
          if (!scene.species.empty() && is_replaced_by_species(key)) continue;
          for (std::size_t n = 0; n < entries_of(section); ++n) require(key, n);
        }
      }
    }
  }
  for (const SceneSection& section : scene_schema()) {
    for (std::size_t n = 0; n < entries_of(section); ++n) {
      for (const SceneKey& key : section.keys) {
        if (key.presence != Presence::required) continue;
        const bool is_of_table = key.key.find('.') != key.key.npos;
        if (!is_of_table || has_table(key, n, given)) require(key, n);
      }
    }
  }
  if (!provided.end && !has_end(scene))
    throw document.missing("an end condition in [until]",
                           "expected one or more of time, collisions_per_needle, energy_ratio, "
                           "wall_s");
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

// A scene to run, or that of a run, which may be read where there is less memory.
enum class Purpose { run, record };

// Scenes of runs that began with a state of the caller leave box or counts to it.
bool says_what_to_draw(const Scene& scene, const std::set<std::string>& given) {
  if (!given.contains("needles.box")) return false;
  if (scene.species.empty()) return given.contains("needles.count");
  for (std::size_t n = 0; n < scene.species.size(); ++n)
    if (!given.contains(key_of_entry("species.count", n))) return false;
  return true;
}

Scene parsed(std::string_view text, std::string_view name, std::span<const Override> overrides,
             Provided provided, Purpose purpose) {
  if (text.size() > max_scene_bytes)
    throw InputError(fmt::format("{}: too large: expected a scene of at most {} bytes",
                                 printable(name), max_scene_bytes));
  const Document document(text, name, overrides);
  Scene scene;
  std::vector<std::string> in_order;  // own names, so that each entry of a list has its keys
  GivenKeys given_keys;
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
    if (!read_value(scene, *key, entry))
      throw document.error(entry, key->expected_instead_of(entry.value));
    if (const auto reason = conflict(entry, given_keys, provided); !reason.empty())
      throw document.error(entry, reason);
    given_keys[{entry.section, entry.number}].insert(full_name(entry));
    in_order.push_back(own_name(entry));
    scene.places[own_name(entry)] = document.place(entry);
  }
  const std::set<std::string> given(in_order.begin(), in_order.end());
  adopt_shapes(scene, given);
  adopt_counts(scene);
  if (purpose == Purpose::record) provided.state |= !says_what_to_draw(scene, given);
  // Before the rules, which look at every body that is drawn: of some billions for minutes.
  const auto is_drawn_each = [](const Species& s) { return s.drawn != DrawnSizes{}; };
  if (purpose == Purpose::run && std::ranges::any_of(scene.species, is_drawn_each))
    require_memory(scene);
  const SceneOrigin origin{.name = name, .given = in_order};
  // A state that is given may say what the scene does not: see adopt_state().
  const bool is_drawn = !provided.state && scene.initial.file.empty();
  // Values before what is missing; where there are walls, the room depends on what they need.
  if (is_drawn) require_rules(scene, Aspect::bodies | Aspect::sizes, origin);
  if (is_drawn && given.contains("needles.box") && scene.walls.empty())
    require_rules(scene, Aspect::room, origin);
  require_what_is_needed(scene, document, given, provided);
  Aspects known = Aspect::species | Aspect::walls | Aspect::effects | Aspect::output;
  if (is_drawn) known = known | Aspect::room | Aspect::start;
  if (is_drawn || !scene.species.empty()) known = known | Aspect::pairs;
  require_rules(scene, known, origin);
  if (is_drawn) adopt_inertias(scene);
  scene.text = annotated(text, overrides);
  return scene;
}

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

Scene parse_scene(std::string_view text, std::string_view name,
                  std::span<const std::string> overrides, Provided provided) {
  return parse_overridden_scene(text, name, of_options(overrides), provided);
}

Scene parse_overridden_scene(std::string_view text, std::string_view name,
                             std::span<const Override> overrides, Provided provided) {
  return parsed(text, name, overrides, provided, Purpose::run);
}

Scene parse_recorded_scene(const std::string& text, std::string_view name) {
  return parsed(text, name, of_options(recorded_overrides(text)), {.end = true}, Purpose::record);
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
  require_rules(scene, Aspect::effects);
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
