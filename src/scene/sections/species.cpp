// [[species]], and [[pairs]] of them: which there may be, and what they may be made of.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "src/composition/pair_name.h"
#include "src/scene/own_bodies.h"
#include "src/scene/printable.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

constexpr ValueRange range_of_inertia{1e-200, 1e200};

std::optional<Violation> two_species_have_one_name(const Scene& scene) {
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    for (std::size_t before = 0; before < n; ++before) {
      if (scene.species[n].name != scene.species[before].name) continue;
      return Violation{.key = key_of_entry("species.name", n),
                       .value = in_quotes(scene.species[n].name),
                       .reason = "expected a name that no other species has",
                       .or_keys = {key_of_entry("species.name", before)}};
    }
  }
  return {};
}

// What is told of each two species names them "a-b", which must not stand for two pairs.
std::optional<Violation> two_pairs_have_one_name(const Scene& scene) {
  const Composition composition = scene.composition();
  std::map<std::string, std::array<std::size_t, 2>> pairs;
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    for (std::size_t other = 0; other <= n; ++other) {
      const std::string name = pair_name(composition, other, n);
      const auto [known, is_new] = pairs.insert({name, {other, n}});
      if (is_new) continue;
      return Violation{
          .key = key_of_entry("species.name", n),
          .value = in_quotes(scene.species[n].name),
          .reason = fmt::format("expected a name with which only one pair of species is called {}",
                                printable(name, 200)),
          .or_keys = {key_of_entry("species.name", other),
                      key_of_entry("species.name", known->second[0]),
                      key_of_entry("species.name", known->second[1])}};
    }
  }
  return {};
}

std::optional<Violation> more_needles_than_ids(const Scene& scene) {
  const std::uint64_t count = scene.composition().count();
  if (scene.species.empty() || count <= most_needles) return {};
  const std::size_t last = scene.species.size() - 1;
  Violation out{.key = key_of_entry("species.count", last),
                .value = fmt::to_string(scene.species[last].count),
                .reason = fmt::format("expected at most {} needles of all species, not {}",
                                      most_needles, count)};
  for (std::size_t n = 0; n < last; ++n) out.or_keys.push_back(key_of_entry("species.count", n));
  return out;
}

// As a number or as it is drawn.
bool has_width(const Species& species) {
  return species.diameter > 0 || species.drawn.diameter || species.drawn.aspect;
}

std::optional<Violation> body_has_no_extent(const Scene& scene) {
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    const Species& species = scene.species[n];
    if (species.length > 0 || species.drawn.length || has_width(species)) continue;
    return Violation{.key = key_of_entry("species.length", n),
                     .value = fmt::to_string(species.length),
                     .reason = "expected a length above 0, or a diameter, which makes it a sphere"};
  }
  return {};
}

std::optional<Violation> inertia_is_impossible(const Scene& scene) {
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    const Species& species = scene.species[n];
    if (!species.given_inertia) continue;
    Violation out{.key = key_of_entry("species.inertia", n),
                  .value = fmt::to_string(*species.given_inertia),
                  .reason = "expected either k or inertia, not both"};
    if (scene.places.contains(key_of_entry("species.k", n))) return out;
    const double k = k_of(species.mass, species.length, *species.given_inertia);
    if (species.drawn != DrawnSizes{}) continue;  // each body is looked at
    if (!species.has_axis()) {
      const Species made = scene.composition()[n];
      if (made.q == 0 || is_inertia_of_sphere(numbers_of(made))) continue;
      out.reason = std::string("expected ") + expected_inertia_of_sphere;
      return out;
    }
    if (range_of_k.holds(k)) continue;
    out.reason = fmt::format("expected one with which k = m L^2 / (2 I) is from {:g} to {:g}",
                             range_of_k.least, range_of_k.greatest);
    return out;
  }
  return {};
}

std::string quoted_pair(const Scene::Pair& pair) {
  return printable(fmt::format("[{}, {}]", in_quotes(pair.between[0]), in_quotes(pair.between[1])),
                   60);
}

std::optional<Violation> pair_is_of_no_species(const Scene& scene) {
  std::vector<std::string> names;
  for (const Species& each : scene.species) names.push_back(each.name);
  for (std::size_t n = 0; n < scene.pairs.size(); ++n) {
    for (const std::string& name : scene.pairs[n].between) {
      if (std::ranges::find(names, name) != names.end()) continue;
      return Violation{.key = key_of_entry("pairs.between", n),
                       .value = quoted_pair(scene.pairs[n]),
                       .reason = fmt::format(
                           "expected names of two [[species]]{}{}", names.empty() ? "" : ", among ",
                           printable(fmt::format("{}", fmt::join(names, ", ")), 200))};
    }
  }
  return {};
}

std::optional<Violation> pair_occurs_twice(const Scene& scene) {
  const auto are_same = [](const Scene::Pair& a, const Scene::Pair& b) {
    return a.between == b.between || (a.between[0] == b.between[1] && a.between[1] == b.between[0]);
  };
  for (std::size_t n = 0; n < scene.pairs.size(); ++n) {
    for (std::size_t before = 0; before < n; ++before) {
      if (!are_same(scene.pairs[before], scene.pairs[n])) continue;
      return Violation{.key = key_of_entry("pairs.between", n),
                       .value = quoted_pair(scene.pairs[n]),
                       .reason = "expected each two species once",
                       .or_keys = {key_of_entry("pairs.between", before)}};
    }
  }
  return {};
}

std::optional<Violation> pair_that_never_meets_collides(const Scene& scene) {
  for (std::size_t n = 0; n < scene.pairs.size(); ++n) {
    const Scene::Pair& pair = scene.pairs[n];
    if (pair.meet || !(pair.epsilon || pair.beta)) continue;
    return Violation{.key = key_of_entry("pairs.meet", n),
                     .value = "false",
                     .reason =
                         "expected either meet = false or epsilon and beta, not both: bodies "
                         "that pass through each other have no rule of collisions",
                     .or_keys = {key_of_entry("pairs.epsilon", n), key_of_entry("pairs.beta", n)}};
  }
  return {};
}

std::optional<Violation> pair_is_fixed(const Scene& scene) {
  const auto is_fixed = [&](const std::string& name) {
    const auto found = std::ranges::find(scene.species, name, &Species::name);
    return found != scene.species.end() && found->fixed;
  };
  for (std::size_t n = 0; n < scene.pairs.size(); ++n) {
    const Scene::Pair& pair = scene.pairs[n];
    if (!pair.meet || !is_fixed(pair.between[0]) || !is_fixed(pair.between[1])) continue;
    return Violation{.key = key_of_entry("pairs.between", n),
                     .value = quoted_pair(pair),
                     .reason = "expected a species that moves: fixed bodies never meet"};
  }
  return {};
}

std::optional<Violation> species_do_not_add_up(const Scene& scene) {
  if (scene.composition().count() == scene.needles.count) return {};
  return Violation{.key = "species", .value = {}, .reason = "expected the count of [needles]"};
}

std::optional<std::array<std::string, 2>> two_names(const Value& value) {
  const auto* names = value.as<Value::Array>();
  if (!names || names->size() != 2) return std::nullopt;
  std::array<std::string, 2> out;
  for (std::size_t n = 0; n < 2; ++n)
    if (!from_value::store(out[n], from_value::text((*names)[n]))) return std::nullopt;
  return out;
}

}  // namespace

SceneSection species_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  constexpr const char* not_both =
      "expected either [[species]] or needles.count, needles.k, needles.diameter and the "
      "temperatures of [initial], not both";
  SceneSection out{
      .name = "species",
      .keys =
          {
              {"name",
               Aspect::output,
               {},
               "a name without control characters, not empty",
               [](Scene& s, V v, R) {
                 return store(s.species.back().name, text(v)) && !s.species.back().name.empty();
               },
               Presence::required},
              {"count", Aspect::start, counts_of_needles, expected_count,
               [](Scene& s, V v, R r) { return store(s.species.back().count, whole_number(v, r)); },
               Presence::to_draw},
              {"length", Aspect::bodies, lengths,
               "a number > 0 (from 1e-6 to 1e6), or 0 for spheres",
               [](Scene& s, V v, R r) { return store(s.species.back().length, number(v, r)); }},
              {"diameter", Aspect::bodies, lengths, expected_diameter,
               [](Scene& s, V v, R r) { return store(s.species.back().diameter, number(v, r)); }},
              {"mass", Aspect::bodies, masses, "a number > 0 (from 1e-100 to 1e100)",
               [](Scene& s, V v, R r) { return store(s.species.back().mass, number(v, r)); }},
              {"k", Aspect::bodies, range_of_k, expected_k,
               [](Scene& s, V v, R r) { return store(s.species.back().k, number(v, r)); }},
              {"inertia", Aspect::bodies, range_of_inertia,
               "a number > 0 (from 1e-200 to 1e200), in place of k",
               [](Scene& s, V v, R r) {
                 return store(s.species.back().given_inertia, number(v, r));
               }},
              {"t_tr", Aspect::start, or_zero(temperatures), expected_temperature,
               [](Scene& s, V v, R r) { return store(s.species.back().t_tr, number(v, r)); }},
              {"t_rot", Aspect::start, or_zero(temperatures), expected_temperature,
               [](Scene& s, V v, R r) { return store(s.species.back().t_rot, number(v, r)); }},
          },
      .rules = {{Aspect::species, two_species_have_one_name},
                {Aspect::species, two_pairs_have_one_name},
                {Aspect::species, more_needles_than_ids},
                {Aspect::bodies, body_has_no_extent},
                {Aspect::bodies, inertia_is_impossible},
                {Aspect::restored, species_do_not_add_up}},
      .exclusions = {{"species.", "needles.count", not_both},
                     {"species.", "needles.k", not_both},
                     {"species.", "needles.diameter", not_both},
                     {"species.", "initial.t_tr", not_both},
                     {"species.", "initial.t_rot", not_both}},
      .entries = entries_in<&Scene::species>(most_species),
  };
  add_sizes(out);
  add_fixed(out);
  return out;
}

SceneSection pairs_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "pairs",
      .keys =
          {
              {"between",
               Aspect::effects,
               {},
               "an array of the names of two species",
               [](Scene& s, V v, R) { return store(s.pairs.back().between, two_names(v)); },
               Presence::required},
              {"epsilon", Aspect::effects, restitutions, expected_epsilon,
               [](Scene& s, V v, R r) { return store(s.pairs.back().epsilon, number(v, r)); }},
              {"beta", Aspect::effects, tangential_restitutions, expected_beta,
               [](Scene& s, V v, R r) { return store(s.pairs.back().beta, number(v, r)); }},
              {"meet",
               Aspect::effects,
               {},
               "true or false",
               [](Scene& s, V v, R) { return store(s.pairs.back().meet, truth(v)); }},
          },
      .rules = {{Aspect::species, pair_occurs_twice},
                {Aspect::pairs, pair_is_of_no_species},
                {Aspect::effects, pair_that_never_meets_collides},
                {Aspect::effects, pair_is_fixed}},
      .entries = entries_in<&Scene::pairs>(most_species * (most_species + 1) / 2),
  };
}

}  // namespace needlework
