// [collisions]: restitution, the t_c rule, sliding contact.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

constexpr const char* one_contact_time = "expected either tc or tc_relative, not both";

// In a file, the two keys exclude each other.
std::optional<Violation> there_are_two_contact_times(const Scene& scene) {
  if (!(scene.collisions.tc && scene.collisions.tc_relative)) return {};
  return Violation{.key = "collisions", .value = {}, .reason = one_contact_time};
}

std::optional<Violation> rods_are_rough(const Scene& scene) {
  const Composition composition = scene.composition();
  if (!composition.has_width() || !composition.is_rough()) return {};
  constexpr const char* reason =
      "expected -1 of pairs with a rod of finite width: what turns it about its axis is not "
      "simulated";
  const auto are_smooth = [&](std::size_t a, std::size_t b) {
    return composition.exclude(a, b) && !composition.are_spheres(a, b);
  };
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(scene.species, name, &Species::name) -
                                    scene.species.begin());
  };
  for (std::size_t n = 0; n < scene.pairs.size(); ++n) {
    const double beta = scene.pairs[n].beta.value_or(-1);
    const std::size_t a = index_of(scene.pairs[n].between[0]),
                      b = index_of(scene.pairs[n].between[1]);
    if (beta == -1 || std::max(a, b) >= scene.species.size() || !are_smooth(a, b)) continue;
    return Violation{
        .key = key_of_entry("pairs.beta", n), .value = fmt::to_string(beta), .reason = reason};
  }
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      if (!composition.restitution(a, b).is_rough() || !are_smooth(a, b)) continue;
      return Violation{.key = "collisions.beta",
                       .value = fmt::to_string(scene.collisions.beta),
                       .reason = reason};
    }
  }
  return {};
}

std::optional<Violation> nothing_slides_that_is_struck(const Scene& scene) {
  if (scene.collisions.sliding || !scene.collisions.elastic_strikes) return {};
  return Violation{
      .key = "collisions.elastic_strikes",
      .value = "true",
      .reason = "expected false, or collisions.sliding = true: only needles in contact are struck"};
}

// What sliding contact does not know of.
std::optional<Violation> these_do_not_slide(const Scene& scene) {
  if (!scene.collisions.sliding) return {};
  const auto refused = [](const char* reason) {
    return Violation{.key = "collisions.sliding", .value = "true", .reason = reason};
  };
  const Composition composition = scene.composition();
  if (composition.is_rough()) {
    return refused(
        "expected false, or beta = -1: needles slide on each other without friction only");
  }
  if (composition.has_width())
    return refused("expected false, as rods of finite width do not slide");
  if (scene.collisions.tc || scene.collisions.tc_relative) {
    return refused(
        "expected either sliding or a contact time, tc or tc_relative: both replace the same "
        "bounces");
  }
  return {};
}

}  // namespace

SceneSection collisions_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "collisions",
      .keys =
          {
              {"epsilon", Aspect::effects, restitutions, expected_epsilon,
               [](Scene& s, V v, R r) { return store(s.collisions.epsilon, number(v, r)); }},
              {"beta", Aspect::effects, tangential_restitutions, expected_beta,
               [](Scene& s, V v, R r) { return store(s.collisions.beta, number(v, r)); }},
              {"tc",
               Aspect::effects,
               {0},
               "a time >= 0",
               [](Scene& s, V v, R r) { return store(s.collisions.tc, number(v, r)); }},
              {"tc_relative",
               Aspect::effects,
               {0},
               "a number >= 0 of mean free times",
               [](Scene& s, V v, R r) { return store(s.collisions.tc_relative, number(v, r)); }},
              {"sliding",
               Aspect::effects,
               {},
               "true or false",
               [](Scene& s, V v, R) { return store(s.collisions.sliding, truth(v)); }},
              {"sliding_below",
               Aspect::effects,
               {1e-6, 0.1},
               "a number from 1e-6 to 0.1 of mean free times",
               [](Scene& s, V v, R r) { return store(s.collisions.sliding_below, number(v, r)); }},
              {"elastic_strikes",
               Aspect::effects,
               {},
               "true or false",
               [](Scene& s, V v, R) { return store(s.collisions.elastic_strikes, truth(v)); }},
          },
      .rules = {{Aspect::effects, there_are_two_contact_times},
                {Aspect::bodies, rods_are_rough},
                {Aspect::effects, nothing_slides_that_is_struck},
                {Aspect::effects, these_do_not_slide}},
      .exclusions = {{"collisions.tc", "collisions.tc_relative", one_contact_time,
                      Replaces::each_the_other}},
  };
}

}  // namespace needlework
