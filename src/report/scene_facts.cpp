#include "src/report/scene_facts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "needlework/theory.h"

namespace needlework::report {

using Json = nlohmann::ordered_json;

namespace {

template <class Value>
Json optional(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

// Those of the last lines alone: a comment of the author further up sets nothing.
std::vector<std::string> recorded_overrides(const std::string& text) {
  constexpr std::string_view mark = "# --set ";
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(mark)) {
      overrides.push_back(line.substr(mark.size()));
    } else {
      overrides.clear();
    }
  }
  return overrides;
}

Json end_of(const Scene::Until& until) {
  return {{"time", optional(until.time)},
          {"collisions_per_needle", optional(until.collisions_per_needle)},
          {"energy_ratio", optional(until.energy_ratio)},
          {"wall_s", optional(until.wall_s)}};
}

// The ratio T_tr / T_rot that theory predicts for late times, null for a gas that does not cool.
Json ratio_of_theory(const Scene& scene) {
  const theory::Gas gas{scene.composition()[0].k, scene.collisions.epsilon, scene.collisions.beta};
  const double ratio = theory::asymptotic_ratio(gas);
  return std::isfinite(ratio) ? Json(ratio) : Json(nullptr);
}

Json facts_of(const Scene& scene) {
  const Species needle = scene.composition()[0];
  return {{"k", needle.k},
          {"length", needle.length},
          {"mass", needle.mass},
          {"t_tr", needle.t_tr},
          {"t_rot", needle.t_rot},
          {"initial_file", scene.initial.file},
          {"epsilon", scene.collisions.epsilon},
          {"beta", scene.collisions.beta},
          {"tc", optional(scene.collisions.tc)},
          {"tc_relative", optional(scene.collisions.tc_relative)},
          {"search", scene.engine.search},
          {"queue", scene.engine.queue},
          {"until", end_of(scene.until)},
          {"ratio_of_theory", ratio_of_theory(scene)}};
}

}  // namespace

Json scene_facts(const std::string& text, const std::string& name) {
  try {
    return facts_of(parse_scene(text, name, recorded_overrides(text)));
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace needlework::report
