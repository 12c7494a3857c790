#include "src/scene/scene_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "needlework/error.h"
#include "src/scene/box_edges.h"
#include "src/scene/scene_members.h"
#include "src/scene/schema.h"

namespace needlework {
namespace {

// Whole numbers beyond those of TOML become a number that no key accepts.
Value toml_of(std::uint64_t n) {
  constexpr auto most = std::numeric_limits<std::int64_t>::max();
  return {n <= std::uint64_t{most} ? static_cast<std::int64_t>(n) : std::int64_t{-1}};
}
Value toml_of(int n) { return {std::int64_t{n}}; }
Value toml_of(double x) { return {x}; }
Value toml_of(bool b) { return {b}; }
Value toml_of(const std::string& text) { return {text}; }

template <class Sequence>
Value array_of(const Sequence& values) {
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

  std::vector<KeyValue> values;

 private:
  // One function for all types: GCC 12 warns, wrongly, where it inlines this for a number.
  void add(std::string_view section, std::string_view key, Value value) {
    values.push_back({section, key, std::move(value)});
  }
};

void refuse(std::string_view name, std::string_view expected) {
  throw InputError(fmt::format("the scene: {}: expected {}", name, expected));
}

}  // namespace

std::vector<KeyValue> values_of(const Scene& scene) {
  Collected collected;
  visit_members(scene, collected);
  return std::move(collected.values);
}

void require_in_range(const Scene& scene, Provided provided) {
  Scene again = scene;
  for (const auto& [section, name, value] : values_of(scene)) {
    const auto* text = value.as<std::string>();
    const bool no_name = section == "species" && name == "name" && text && text->empty();
    const bool no_box = provided.state && section == "needles" && name == "box";
    const SceneKey* key = find_scene_key(section, name);
    if (no_name || no_box || key->read(again, value)) continue;
    refuse(section.empty() ? std::string(name) : fmt::format("{}.{}", section, name),
           key->expected);
  }
  if (scene.collisions.tc && scene.collisions.tc_relative) {
    refuse("collisions", "either tc or tc_relative, not both");
  }
  if (provided.state || scene.species.size() > 1) return;
  const double least = least_edge(scene.one_species().length);
  if (std::ranges::any_of(scene.needles.box, [&](double edge) { return edge < least; })) {
    refuse("needles.box", "edges of at least 2.01 needle lengths");
  }
}

void require_valid(const Scene& scene) {
  require_in_range(scene);
  if (scene.species.size() > 1) refuse("species", "one");
  const Scene::Species species = scene.one_species();
  if (species.count != scene.needles.count || species.k != scene.needles.k) {
    refuse("species", "the count and k of [needles]");
  }
  if (!scene.species.empty() && species.name.empty()) refuse("species.name", "a name");
  if (scene.text.size() > max_scene_bytes) refuse("text", "at most 1 MiB");
}

}  // namespace needlework
