#include "src/scene/scene_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <optional>
#include <utility>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/scene/bodies.h"
#include "src/scene/box_edges.h"
#include "src/scene/confinement.h"
#include "src/scene/derived_numbers.h"
#include "src/scene/printable.h"
#include "src/scene/scene_members.h"
#include "src/scene/schema.h"

namespace needlework {
namespace {

// Whole numbers beyond those of TOML become real ones, which no key for whole numbers accepts.
Value toml_of(std::uint64_t n) {
  constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();
  if (n > most) return {static_cast<double>(n)};
  return {static_cast<std::int64_t>(n)};
}
Value toml_of(int n) { return {std::int64_t{n}}; }
Value toml_of(double x) { return {x}; }
Value toml_of(bool b) { return {b}; }
Value toml_of(const std::string& text) { return {text}; }

// Not inlined, as GCC 12 warns of uninitialized memory, wrongly, where it is.
template <class Sequence>
[[gnu::noinline]] Value array_of(const Sequence& values) {
  Value::Array out;
  for (const auto& value : values) out.push_back(toml_of(value));
  return {std::move(out)};
}
template <class T, std::size_t size>
Value toml_of(const std::array<T, size>& values) {
  return array_of(values);
}
template <class T>
Value toml_of(const std::vector<T>& values) {
  return array_of(values);
}

// Collects the values of members.
class Collected {
 public:
  template <class T>
  void operator()(std::string_view section, std::string_view key, const T& value) {
    add(section, key, toml_of(value));
  }
  template <class T>
  void operator()(std::string_view section, std::string_view key, const std::optional<T>& value) {
    if (value) (*this)(section, key, *value);
  }
  void operator()(std::string_view section, std::string_view key, const std::string& text) {
    const bool is_given = section != "initial" || !text.empty();  // initial.file has no empty value
    if (is_given) add(section, key, toml_of(text));
  }
  void operator()(std::string_view, std::string_view, const std::vector<Scene::Species>& all) {
    for (const Scene::Species& species : all) visit_species(species, *this);
  }
  void operator()(std::string_view, std::string_view, const std::vector<Scene::Pair>& all) {
    for (const Scene::Pair& pair : all) visit_pair(pair, *this);
  }
  void operator()(std::string_view, std::string_view, const std::vector<Scene::Wall>& all) {
    for (const Scene::Wall& wall : all) visit_wall(wall, *this);
  }
  void operator()(std::string_view, std::string_view, const Scene::WallMotion& motion) {
    visit_motion(motion, *this);
  }
  void operator()(std::string_view, std::string_view, const Scene::Kicks& kicks) {
    visit_kicks(kicks, *this);
  }
  void operator()(std::string_view, std::string_view, const Scene::Andersen& andersen) {
    visit_andersen(andersen, *this);
  }

  std::vector<KeyValue> values;

 private:
  // One function for all types: GCC 12 warns, wrongly, where it inlines this for a number.
  [[gnu::noinline]] void add(std::string_view section, std::string_view key, Value value) {
    values.push_back({section, key, std::move(value)});
  }
};

// As messages quote it.
std::string quoted(const Value& value) {
  if (const auto* truth = value.as<bool>()) return *truth ? "true" : "false";
  if (const auto* whole = value.as<std::int64_t>()) return fmt::to_string(*whole);
  if (const auto* real = value.as<double>()) return fmt::to_string(*real);
  if (const auto* text = value.as<std::string>()) return '"' + printable(*text, 60) + '"';
  std::vector<std::string> elements;
  for (const Value& element : *value.as<Value::Array>()) elements.push_back(quoted(element));
  return printable(fmt::format("[{}]", fmt::join(elements, ", ")), 60);
}

void refuse(std::string_view what, std::string_view expected) {
  throw InputError(fmt::format("the scene: {}: expected {}", what, expected));
}

// Of the keys for which is_looked_at(section, key) holds.
template <class Predicate>
void require_in_range(const Scene& scene, Predicate&& is_looked_at) {
  Scene again = scene;
  if (again.species.empty()) again.species.emplace_back();
  if (again.pairs.empty()) again.pairs.emplace_back();
  if (again.walls.empty()) again.walls.emplace_back();
  for (const auto& [section, name, value] : values_of(scene)) {
    const SceneKey* key = find_scene_key(section, name);
    if (!is_looked_at(section, name) || key->read(again, value)) continue;
    throw InputError(fmt::format("the scene: {}{}{} = {}: {}", section, section.empty() ? "" : ".",
                                 name, quoted(value), key->expected_instead_of(value)));
  }
}

bool is_among(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

void require_one_contact_time(const Scene::Collisions& collisions) {
  if (collisions.tc && collisions.tc_relative)
    refuse("collisions", "either tc or tc_relative, not both");
}

// That species can be told apart, and that pairs are of them.
void require_names(const Scene& scene) {
  if (scene.species.size() > most_species)
    refuse("species", fmt::format("at most {}", most_species));
  const auto with_name = [&](const std::string& name) {
    return std::ranges::count(scene.species, name, &Species::name);
  };
  for (const Species& each : scene.species) {
    if (scene.species.size() > 1 && with_name(each.name) != 1)
      refuse(fmt::format("species.name = {}", quoted(toml_of(each.name))),
             "a name that no other species has");
  }
  for (const Scene::Pair& pair : scene.pairs) {
    for (const std::string& name : pair.between) {
      if (with_name(name) == 0)
        refuse(fmt::format("pairs.between = {}", quoted(toml_of(pair.between))),
               "names of two species");
    }
  }
}

void require_room(const Scene& scene) {
  const Room room(scene);
  if (!room.holds(scene.needles.box))
    refuse(fmt::format("needles.box = {}", quoted(toml_of(scene.needles.box))),
           room.expected_instead_of(scene.needles.box));
}

}  // namespace

std::vector<KeyValue> values_of(const Scene& scene) {
  Collected collected;
  visit_members(scene, collected);
  return std::move(collected.values);
}

void require_simulable(const Scene& scene) {
  require_in_range(scene, [&](std::string_view section, std::string_view key) {
    if (section == "species") return is_among(key, {"length", "mass", "k", "diameter", "inertia"});
    if (section == "needles") return is_among(key, {"k", "diameter"}) && scene.species.empty();
    return section == "collisions" || section == "pairs" || section == "walls" ||
           section == "forces" || section == "driving" || section == "engine";
  });
  require_one_contact_time(scene.collisions);
  require_names(scene);
  require_possible_bodies(scene);
  require_compatible_effects(scene);
}

void require_drawable(const Scene& scene) {
  require_in_range(scene, [&](std::string_view section, std::string_view key) {
    if (section == "species") return key != "name";
    if (section == "needles")
      return key == "box" || (is_among(key, {"count", "k", "diameter"}) && scene.species.empty());
    if (section == "walls") return true;
    return section == "initial" && key != "file" && scene.species.empty();
  });
  require_possible_bodies(scene);
  require_room(scene);
  const Composition composition = scene.composition();
  if (is_too_sparse(scene.needles.box, static_cast<double>(composition.count()),
                    composition.longest()))
    refuse(fmt::format("needles.box = {}", quoted(toml_of(scene.needles.box))), not_too_sparse);
  if (const std::string reason = out_of_range(numbers_of_drawn(scene)); !reason.empty())
    throw InputError("the scene: its needles and temperatures give " + reason);
}

void require_valid(const Scene& scene) {
  require_in_range(scene, [](std::string_view, std::string_view) { return true; });
  require_one_contact_time(scene.collisions);
  require_possible_bodies(scene);
  require_compatible_effects(scene);
  require_walls_to_observe(scene);
  require_room(scene);
  require_names(scene);
  if (scene.composition().count() != scene.needles.count)
    refuse("species", "the count of [needles]");
  if (scene.text.size() > max_scene_bytes) refuse("text", "at most 1 MiB");
}

}  // namespace needlework
