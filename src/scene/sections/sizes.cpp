// [[species]]: bodies that differ within a species, by distributions of their numbers.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "src/scene/own_bodies.h"
#include "src/scene/printable.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

using namespace from_value;
using Shape = Distribution::Shape;

constexpr const char* expected_shape = R"("uniform", "normal", "lognormal", "gamma" or "powerlaw")";
constexpr ValueRange any_size{1e-100, 1e100};
constexpr const char* expected_size = "a number > 0 (from 1e-100 to 1e100)";

template <auto quantity>
Distribution& distribution_of(Scene& scene) {
  std::optional<Distribution>& out = scene.species.back().drawn.*quantity;
  if (!out) out.emplace();
  return *out;
}

bool store_shape(Shape& shape, const Value& value) {
  const auto name = text(value);
  const auto found = std::ranges::find(Distribution::shape_names, name.value_or(""));
  if (found == Distribution::shape_names.end()) return false;
  shape = static_cast<Shape>(found - Distribution::shape_names.begin());
  return true;
}

template <auto quantity>
void add_keys(const DrawnQuantity& its, std::vector<SceneKey>& to) {
  using V = const Value&;
  using R = const ValueRange&;
  const auto& keys = its.keys;
  to.push_back({keys[0], Aspect::bodies, {}, expected_shape, [](Scene& s, V v, R) {
                  return store_shape(distribution_of<quantity>(s).shape, v);
                }});
  to.push_back({keys[1], Aspect::bodies, any_size, expected_size, [](Scene& s, V v, R r) {
                  return store(distribution_of<quantity>(s).mean, number(v, r));
                }});
  to.push_back(
      {keys[2],
       Aspect::bodies,
       {0, 1},
       "the standard deviation over the mean, from 0 to 1",
       [](Scene& s, V v, R r) { return store(distribution_of<quantity>(s).width, number(v, r)); }});
  to.push_back({keys[3], Aspect::bodies, any_size, expected_size, [](Scene& s, V v, R r) {
                  return store(distribution_of<quantity>(s).least, number(v, r));
                }});
  to.push_back({keys[4], Aspect::bodies, any_size, expected_size, [](Scene& s, V v, R r) {
                  return store(distribution_of<quantity>(s).greatest, number(v, r));
                }});
  to.push_back({keys[5],
                Aspect::bodies,
                {-20, 20},
                "the exponent of a power law, from -20 to 20",
                [](Scene& s, V v, R r) {
                  return store(distribution_of<quantity>(s).exponent, number(v, r));
                }});
}

// The first thing that is wrong with a distribution of the species `n`.
std::optional<Violation> what_is_wrong_with(const Scene& scene, std::size_t n,
                                            const DrawnQuantity& quantity) {
  const auto& distribution = scene.species[n].drawn.*quantity.member;
  if (!distribution) return {};
  const auto key_of = [&](std::string_view key) {
    return key_of_entry(fmt::format("species.{}", key), n);
  };
  const auto is_given = [&](std::string_view key) { return scene.places.contains(key_of(key)); };
  const auto& [shape, mean, width, least, greatest, exponent] = quantity.keys;
  for (const std::string_view key : {mean, width, least, greatest, exponent}) {
    if (!is_given(key) || is_given(shape)) continue;
    return Violation{.key = key_of(key),
                     .value = {},
                     .reason = fmt::format("expected {} beside it: {}", shape, expected_shape)};
  }
  const auto wrong = what_is_wrong(*distribution);
  if (!wrong) return {};
  const char* name = name_of(distribution->shape);
  const std::string key = fmt::format("{}.{}", quantity.name, wrong->name);
  if (wrong->value) {
    return Violation{.key = key_of(key),
                     .value = fmt::to_string(*wrong->value),
                     .reason = fmt::format("expected {} ({} distribution)", wrong->expected, name)};
  }
  return Violation{.key = key_of(shape),
                   .value = in_quotes(name),
                   .reason = fmt::format("expected {} beside it: {}", key, wrong->expected)};
}

std::optional<Violation> distribution_is_wrong(const Scene& scene) {
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    for (const DrawnQuantity& each : drawn_quantities) {
      if (auto wrong = what_is_wrong_with(scene, n, each)) return wrong;
    }
  }
  return {};
}

// The key by which a species says how a number of its bodies comes about.
std::string key_of_quantity(const Species& species, std::string_view quantity) {
  if (quantity == "inertia" && species.drawn.k) return key_of_quantity(species, "k");
  const auto its = std::ranges::find(drawn_quantities, quantity, &DrawnQuantity::name);
  if (const auto& distribution = species.drawn.*its->member)
    return fmt::format("{}.{}", quantity, distribution->mean ? "mean" : "min");
  if (quantity == "mass" && species.drawn.density) return "mass.density";
  if (quantity == "diameter" && species.drawn.aspect) return "diameter.aspect";
  return std::string(quantity);
}

// What would be drawn is known to be a body that a scene may have.
std::optional<Violation> drawn_body_is_impossible(const Scene& scene) {
  std::uint64_t first = 0;
  const Composition composition = scene.composition();
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    const Species species = as_drawn(scene.species[n], composition[n]);
    const auto wrong = wrong_body_of(species, scene.needles.seed, first);
    first += species.count;
    if (!wrong) continue;
    const std::string key = key_of_quantity(species, wrong->quantity);
    return Violation{.key = key_of_entry("species." + key, n),
                     .value = {},
                     .reason = fmt::format("needle {} would have {}: expected {}", wrong->id,
                                           wrong->value, wrong->expected)};
  }
  return {};
}

}  // namespace

void add_sizes(SceneSection& species) {
  using V = const Value&;
  using R = const ValueRange&;
  add_keys<&DrawnSizes::length>(drawn_quantities[0], species.keys);
  add_keys<&DrawnSizes::diameter>(drawn_quantities[1], species.keys);
  species.keys.push_back(
      {"diameter.aspect",
       Aspect::bodies,
       {1e-6, 1e6},
       "length over diameter, > 0 (from 1e-6 to 1e6)",
       [](Scene& s, V v, R r) { return store(s.species.back().drawn.aspect, number(v, r)); }});
  add_keys<&DrawnSizes::mass>(drawn_quantities[2], species.keys);
  species.keys.push_back(
      {"mass.density",
       Aspect::bodies,
       {1e-100, 1e100},
       "mass per length of thin needles, mass per volume of rods and spheres, "
       "> 0 (from 1e-100 to 1e100)",
       [](Scene& s, V v, R r) { return store(s.species.back().drawn.density, number(v, r)); }});
  add_keys<&DrawnSizes::k>(drawn_quantities[3], species.keys);
  add_keys<&DrawnSizes::inertia>(drawn_quantities[4], species.keys);
  // Before others look at what is drawn.
  species.rules.insert(species.rules.begin(), {Aspect::bodies, distribution_is_wrong});
  species.rules.push_back({Aspect::bodies, drawn_body_is_impossible});
  constexpr const char* one_of_both = "expected either a number or how numbers are drawn, not both";
  constexpr const char* one_of_masses =
      "expected either mass.density or mass.distribution, not both";
  constexpr const char* one_of_diameters =
      "expected either diameter.aspect or diameter.distribution, not both";
  constexpr const char* k_or_inertia = "expected either k or inertia, not both";
  const auto exclude = [&](std::string_view one, std::string_view other, const char* expected) {
    species.exclusions.push_back({one, other, expected, Replaces::each_the_other});
  };
  exclude("species.length", "species.length.", one_of_both);
  exclude("species.diameter", "species.diameter.", one_of_both);
  exclude("species.mass", "species.mass.", one_of_both);
  exclude("species.k", "species.k.", one_of_both);
  exclude("species.inertia", "species.inertia.", one_of_both);
  exclude("species.mass.density", "species.mass.distribution", one_of_masses);
  exclude("species.diameter.aspect", "species.diameter.distribution", one_of_diameters);
  exclude("species.k.distribution", "species.inertia", k_or_inertia);
  exclude("species.k.distribution", "species.inertia.", k_or_inertia);
  exclude("species.k", "species.inertia.", k_or_inertia);
}

}  // namespace needlework
