// [driving]: kicks and a thermostat.
#include <fmt/format.h>

#include <utility>

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

Scene::Growth& growth_of(Scene& scene) {
  auto& growth = scene.driving.growth;
  if (!growth) growth = Scene::Growth{};
  return *growth;
}

Violation violation_of_growth(const Scene& scene, std::string reason) {
  return {.key = "driving.growth.rate",
          .value = fmt::to_string(scene.driving.growth->rate),
          .reason = std::move(reason)};
}

std::optional<Violation> thin_or_fixed_bodies_grow(const Scene& scene) {
  if (!scene.driving.growth) return {};
  const Composition composition = scene.composition();
  for (const Species& each : composition.species()) {
    if (each.count == 0 && composition.is_mixture()) continue;
    if (each.diameter == 0)
      return violation_of_growth(
          scene, "expected bodies with a diameter: thin needles take up no room, however long");
    if (each.fixed) return violation_of_growth(scene, "expected none beside bodies that are fixed");
  }
  return {};
}

std::optional<Violation> growth_is_beside_other_driving(const Scene& scene) {
  if (!scene.driving.growth) return {};
  if (scene.driving.kicks || scene.driving.andersen)
    return violation_of_growth(
        scene, "expected none beside kicks and thermostats: it keeps the temperature itself");
  if (scene.shear && scene.shear->rate != 0)
    return violation_of_growth(scene, "expected none beside a shear.rate, which heats");
  for (const Scene::Wall& wall : scene.walls) {
    if (wall.motion && (wall.motion->velocity || wall.motion->tangential))
      return violation_of_growth(scene, "expected none beside walls with a velocity");
  }
  return {};
}

std::optional<Violation> has_grown_at_the_start(const Scene& scene) {
  const auto& growth = scene.driving.growth;
  if (!growth || !growth->until_packing) return {};
  const auto& box = scene.needles.box;
  const double packing = scene.composition().packing_fraction(box[0] * box[1] * box[2]);
  if (packing < *growth->until_packing) return {};
  return Violation{.key = "driving.growth.until_packing",
                   .value = fmt::to_string(*growth->until_packing),
                   .reason = fmt::format(
                       "expected more than the packing fraction at the start, {:.6g}", packing)};
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
              {"growth.rate",
               Aspect::effects,
               {1e-9, 10},
               "a number > 0 (from 1e-9 to 10)",
               [](Scene& s, V v, R r) { return store(growth_of(s).rate, number(v, r)); },
               Presence::required},
              {"growth.until_packing",
               Aspect::effects,
               {1e-9, 1},
               "a number > 0 (from 1e-9 to 1)",
               [](Scene& s, V v, R r) { return store(growth_of(s).until_packing, number(v, r)); }},
              {"growth.until_pressure",
               Aspect::effects,
               {1, 1e10},
               "a number from 1 to 1e10",
               [](Scene& s, V v, R r) { return store(growth_of(s).until_pressure, number(v, r)); }},
              {"growth.cool_every",
               Aspect::effects,
               {0, 1e6},
               "a number >= 0 (at most 1e6)",
               [](Scene& s, V v, R r) { return store(growth_of(s).cool_every, number(v, r)); }},
          },
      .rules = {{Aspect::effects, thermostat_is_beside_gravity},
                {Aspect::sizes, thin_or_fixed_bodies_grow},
                {Aspect::effects, growth_is_beside_other_driving},
                {Aspect::room, has_grown_at_the_start}},
  };
}

}  // namespace needlework
