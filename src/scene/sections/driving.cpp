// [driving]: kicks and a thermostat.
#include <fmt/format.h>

#include "src/scene/confinement.h"
#include "src/scene/read_value.h"
#include "src/scene/sections/sections.h"

namespace needlework {
namespace {

constexpr ValueRange rates{1 / largest_rate, largest_rate};
constexpr ValueRange strengths{0, largest_rate};
constexpr const char* expected_strength = "a number >= 0 (at most 1e100)";

// The tables are made by the first key of theirs that is read.
Scene::Kicks& kicks_of(Scene& scene) {
  auto& kicks = scene.driving.kicks;
  if (!kicks) kicks = Scene::Kicks{};
  return *kicks;
}
Scene::Andersen& andersen_of(Scene& scene) {
  auto& andersen = scene.driving.andersen;
  if (!andersen) andersen = Scene::Andersen{};
  return *andersen;
}

std::optional<Violation> thermostat_is_beside_gravity(const Scene& scene) {
  if (!scene.driving.andersen || !has_gravity(scene)) return {};
  return Violation{
      .key = "driving.andersen.rate",
      .value = fmt::to_string(scene.driving.andersen->rate),
      .reason =
          "expected none beside forces.gravity: the thermostat is for needles that fly freely"};
}

}  // namespace

SceneSection driving_section() {
  using namespace from_value;
  using V = const Value&;
  using R = const ValueRange&;
  return {
      .name = "driving",
      .keys =
          {
              {"kicks.every", Aspect::effects, rates, "a time > 0 (from 1e-100 to 1e100)",
               [](Scene& s, V v, R r) { return store(kicks_of(s).every, number(v, r)); },
               Presence::required},
              {"kicks.translational", Aspect::effects, strengths, expected_strength,
               [](Scene& s, V v, R r) { return store(kicks_of(s).translational, number(v, r)); }},
              {"kicks.rotational", Aspect::effects, strengths, expected_strength,
               [](Scene& s, V v, R r) { return store(kicks_of(s).rotational, number(v, r)); }},
              {"andersen.rate", Aspect::effects, rates,
               "a number > 0 of redraws per time (from 1e-100 to 1e100)",
               [](Scene& s, V v, R r) { return store(andersen_of(s).rate, number(v, r)); },
               Presence::required},
              {"andersen.temperature", Aspect::effects, temperatures, expected_positive_temperature,
               [](Scene& s, V v, R r) { return store(andersen_of(s).temperature, number(v, r)); },
               Presence::required},
          },
      .rules = {{Aspect::effects, thermostat_is_beside_gravity}},
  };
}

}  // namespace needlework
