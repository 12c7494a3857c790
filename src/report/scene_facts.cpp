#include "src/report/scene_facts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "needlework/theory.h"
#include "src/composition/pair_name.h"
#include "src/io/formats/material.h"
#include "src/json/results.h"
#include "src/scene/adopt_state.h"
#include "src/scene/confinement.h"

namespace needlework::report {

using Json = nlohmann::ordered_json;

namespace {

template <class Value>
Json optional(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json end_of(const Scene::Until& until) {
  return {{"time", optional(until.time)},
          {"collisions_per_needle", optional(until.collisions_per_needle)},
          {"energy_ratio", optional(until.energy_ratio)},
          {"wall_s", optional(until.wall_s)}};
}

// The ratio T_tr / T_rot that theory predicts for late times, null for a gas that does not cool,
// for mixtures and rods, and where something else than collisions of pairs
// acts on the gas.
Json ratio_of_theory(const Scene& scene, const Composition& composition) {
  if (!composition.is_needle_gas() || acts_on_single_needles(scene)) return nullptr;
  const Restitution& rule = composition.restitution(0, 0);
  const theory::Gas gas{composition[0].k, rule.epsilon, rule.beta};
  const double ratio = theory::asymptotic_ratio(gas);
  return std::isfinite(ratio) ? Json(ratio) : Json(nullptr);
}

Json species_of(const Composition& composition) {
  Json out = Json::array();
  for (const Species& each : composition.species()) {
    out.push_back({{"name", each.name},
                   {"count", each.count},
                   {"fixed", each.fixed},
                   {"differ", each.sizes.has_value()},
                   {"length", each.length},
                   {"diameter", each.diameter},
                   {"mass", each.mass},
                   {"k", json::k_of(each)},
                   {"t_tr", each.t_tr},
                   {"t_rot", each.t_rot},
                   {"rotations", each.rotations()}});
    json::add_sizes(out.back(), each);
  }
  return out;
}

// Those that differ from [collisions].
Json pairs_of(const Composition& composition, const Restitution& usual) {
  Json out = Json::array();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const Restitution& rule = composition.restitution(a, b);
      if (composition[a].fixed && composition[b].fixed) continue;
      if (!composition.meets(a, b)) {
        out.push_back({{"name", pair_name(composition, a, b)}, {"meet", false}});
        continue;
      }
      if (rule == usual) continue;
      out.push_back(
          {{"name", pair_name(composition, a, b)}, {"epsilon", rule.epsilon}, {"beta", rule.beta}});
    }
  }
  return out;
}

Json walls_of(const Scene& scene) {
  Json out = Json::array();
  for (const Scene::Wall& wall : io::single_walls(scene.walls)) {
    Json motion = nullptr;
    if (wall.motion) {
      motion = json::motion_of(*wall.motion);
    }
    out.push_back({{"axis", wall.axis},
                   {"side", wall.side},
                   {"epsilon", wall.epsilon},
                   {"temperature", optional(wall.temperature)},
                   {"motion", std::move(motion)}});
  }
  return out;
}

Json driving_of(const Scene::Driving& driving) {
  Json out = {{"kicks", nullptr}, {"andersen", nullptr}, {"growth", nullptr}};
  if (const auto& kicks = driving.kicks) {
    out["kicks"] = {{"every", kicks->every},
                    {"translational", kicks->translational},
                    {"rotational", kicks->rotational}};
  }
  if (const auto& andersen = driving.andersen) {
    out["andersen"] = {{"rate", andersen->rate}, {"temperature", andersen->temperature}};
  }
  if (const auto& growth = driving.growth) {
    out["growth"] = {{"rate", growth->rate},
                     {"until_packing", optional(growth->until_packing)},
                     {"until_pressure", optional(growth->until_pressure)}};
  }
  return out;
}

}  // namespace

// Of a mixture the longest extent and the mean mass of those that move; what belongs to each
// species is with it.
Json scene_facts(const Scene& scene) {
  const Composition composition = scene.composition();
  const Species& needle = composition[0];
  const bool one = !composition.is_mixture();
  const std::uint64_t moving = composition.count() - composition.fixed();
  double mass = 0;
  for (const Species& each : composition.species()) {
    if (each.fixed) continue;
    mass += each.mass * (one ? 1 : static_cast<double>(each.count) / static_cast<double>(moving));
  }
  const auto& box = scene.needles.box;
  const double volume = box[0] * box[1] * box[2];
  const auto of_one = [&](double value) { return one ? Json(value) : Json(nullptr); };
  return {{"species", one ? Json::array() : species_of(composition)},
          {"pairs", pairs_of(composition, {scene.collisions.epsilon, scene.collisions.beta})},
          {"k", one ? json::k_of(needle) : Json(nullptr)},
          {"differ", one && needle.sizes.has_value()},
          {"length", one ? needle.length : composition.longest()},
          {"diameter", of_one(needle.diameter)},
          {"packing_fraction",
           composition.has_width() ? Json(composition.packing_fraction(volume)) : Json(nullptr)},
          {"mass", mass},
          {"t_tr", of_one(needle.t_tr)},
          {"t_rot", of_one(needle.t_rot)},
          {"rotations", one ? Json(needle.rotations()) : Json(nullptr)},
          {"initial_file", scene.initial.file},
          {"epsilon", scene.collisions.epsilon},
          {"beta", scene.collisions.beta},
          {"tc", optional(scene.collisions.tc)},
          {"tc_relative", optional(scene.collisions.tc_relative)},
          {"sliding_below",
           scene.collisions.sliding ? Json(scene.collisions.sliding_below) : Json(nullptr)},
          {"walls", walls_of(scene)},
          {"gravity", scene.forces.gravity},
          {"shear_rate", scene.shear ? Json(scene.shear->rate) : Json(nullptr)},
          {"driving", driving_of(scene.driving)},
          {"search", scene.engine.search},
          {"queue", scene.engine.queue},
          {"until", end_of(scene.until)},
          {"ratio_of_theory", ratio_of_theory(scene, composition)}};
}

std::optional<Scene> recorded_scene(const std::string& text, const std::string& name,
                                    const Bodies& bodies, const std::vector<double>& counts) {
  try {
    Scene scene = parse_recorded_scene(text, name);
    const bool is_drawn = scene.initial.file.empty() && scene.composition().count() > 0 &&
                          scene.needles.box != std::array<double, 3>{};
    if (is_drawn) return scene;
    adopt_bodies(scene, bodies);
    for (std::size_t n = 0; n < scene.species.size() && n < counts.size(); ++n)
      scene.species[n].count = static_cast<std::uint64_t>(counts[n]);
    return scene;
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace needlework::report
