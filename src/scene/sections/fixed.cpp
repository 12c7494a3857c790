// [[species]]: bodies that do not move.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "src/scene/confinement.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

using namespace from_value;

// The first fixed species.
std::optional<std::size_t> first_fixed(const Scene& scene) {
  const auto found = std::ranges::find_if(scene.species, &Species::fixed);
  if (found == scene.species.end()) return {};
  return static_cast<std::size_t>(found - scene.species.begin());
}

std::optional<Violation> fixed_bodies_have_motion(const Scene& scene) {
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    const Species& species = scene.species[n];
    if (!species.fixed) {
      if (!species.overlap) continue;
      return Violation{.key = key_of_entry("species.overlap", n),
                       .value = "true",
                       .reason = "expected fixed = true beside it: bodies that move never overlap"};
    }
    for (const char* key : {"mass", "mass.distribution", "mass.density", "k", "k.distribution",
                            "inertia", "inertia.distribution", "t_tr", "t_rot"}) {
      const std::string name = key_of_entry(fmt::format("species.{}", key), n);
      if (!scene.places.contains(name)) continue;
      return Violation{
          .key = name,
          .value = {},
          .reason = "expected none, as its species is fixed: of infinite mass, and at rest"};
    }
  }
  return {};
}

std::optional<Violation> nothing_moves(const Scene& scene) {
  const auto fixed = first_fixed(scene);
  if (!fixed || !std::ranges::all_of(scene.species, &Species::fixed)) return {};
  return Violation{.key = key_of_entry("species.fixed", *fixed),
                   .value = "true",
                   .reason = "expected another species, which moves"};
}

// Each of these would need a treatment of its own of pairs of which one is at rest.
std::optional<Violation> fixed_bodies_are_not_simulated(const Scene& scene) {
  const auto fixed = first_fixed(scene);
  if (!fixed) return {};
  const auto refused = [&](const char* expected, std::string other) {
    return Violation{.key = key_of_entry("species.fixed", *fixed),
                     .value = "true",
                     .reason = expected,
                     .or_keys = {std::move(other)}};
  };
  if (has_gravity(scene)) {
    return refused(
        "expected no gravity: beside fixed bodies, the relative motion of a pair is a "
        "parabola, which is not simulated",
        "forces.gravity");
  }
  if (scene.collisions.sliding)
    return refused("expected no sliding contacts, which are of two needles that move",
                   "collisions.sliding");
  if (scene.shear)
    return refused("expected no [shear], whose images move past fixed bodies", "shear.rate");
  return {};
}

}  // namespace

void add_fixed(SceneSection& species) {
  using V = const Value&;
  using R = const ValueRange&;
  species.keys.push_back({"fixed", Aspect::bodies, {}, "true or false", [](Scene& s, V v, R) {
                            return store(s.species.back().fixed, truth(v));
                          }});
  species.keys.push_back({"overlap", Aspect::bodies, {}, "true or false", [](Scene& s, V v, R) {
                            return store(s.species.back().overlap, truth(v));
                          }});
  species.rules.push_back({Aspect::bodies, fixed_bodies_have_motion});
  species.rules.push_back({Aspect::bodies, nothing_moves});
  species.rules.push_back({Aspect::effects, fixed_bodies_are_not_simulated});
}

}  // namespace needlework
