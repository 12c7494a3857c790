#include "src/scene/scene_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <optional>
#include <utility>

#include "src/scene/own_bodies.h"
#include "src/scene/printable.h"
#include "src/scene/scene_members.h"
#include "src/scene/section.h"

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
  void operator()(std::string_view section, std::string_view, const DrawnSizes& drawn) {
    for (const DrawnQuantity& each : drawn_quantities) {
      const auto& distribution = drawn.*each.member;
      if (!distribution) continue;
      const auto& [shape, mean, width, least, greatest, exponent] = each.keys;
      (*this)(section, shape, std::string(name_of(distribution->shape)));
      (*this)(section, mean, distribution->mean);
      (*this)(section, width, distribution->width);
      (*this)(section, least, distribution->least);
      (*this)(section, greatest, distribution->greatest);
      (*this)(section, exponent, distribution->exponent);
    }
    (*this)(section, "mass.density", drawn.density);
    (*this)(section, "diameter.aspect", drawn.aspect);
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
  void operator()(std::string_view, std::string_view, const Scene::Shear& shear) {
    visit_shear(shear, *this);
  }
  void operator()(std::string_view, std::string_view, const Scene::Kicks& kicks) {
    visit_kicks(kicks, *this);
  }
  void operator()(std::string_view, std::string_view, const Scene::Andersen& andersen) {
    visit_andersen(andersen, *this);
  }
  void operator()(std::string_view, std::string_view, const Scene::Growth& growth) {
    visit_growth(growth, *this);
  }

  std::vector<KeyValue> values;

 private:
  // One function for all types: GCC 12 warns, wrongly, where it inlines this for a number.
  [[gnu::noinline]] void add(std::string_view section, std::string_view key, Value value) {
    values.push_back({section, key, std::move(value)});
  }
};

}  // namespace

std::vector<KeyValue> values_of(const Scene& scene) {
  Collected collected;
  visit_members(scene, collected);
  return std::move(collected.values);
}

std::string in_quotes(const Value& value) {
  if (const auto* truth = value.as<bool>()) return *truth ? "true" : "false";
  if (const auto* whole = value.as<std::int64_t>()) return fmt::to_string(*whole);
  if (const auto* real = value.as<double>()) return fmt::to_string(*real);
  if (const auto* text = value.as<std::string>()) return in_quotes(*text);
  std::vector<std::string> elements;
  for (const Value& element : *value.as<Value::Array>()) elements.push_back(in_quotes(element));
  return printable(fmt::format("[{}]", fmt::join(elements, ", ")), 60);
}

}  // namespace needlework
