#include "src/scene/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "needlework/error.h"
#include "src/composition/pair_name.h"
#include "src/scene/confinement.h"
#include "src/scene/printable.h"

namespace needlework {

namespace {

// The rules by which needles of some pair of species collide, each once, with its key.
struct Rule {
  std::string epsilon;  ///< as messages name it
  Restitution restitution;
};

std::vector<Rule> rules_of(const Scene& scene, const Composition& composition) {
  const Restitution usual{scene.collisions.epsilon, scene.collisions.beta};
  std::vector<Rule> out;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      if (!composition.meets(a, b)) continue;
      const Restitution& rule = composition.restitution(a, b);
      const bool is_known =
          std::ranges::any_of(out, [&](const Rule& other) { return other.restitution == rule; });
      if (is_known) continue;
      out.push_back({rule == usual ? fmt::format("collisions.epsilon = {}", rule.epsilon)
                                   : fmt::format("pairs.epsilon = {} of {}", rule.epsilon,
                                                 printable(pair_name(composition, a, b), 200)),
                     rule});
    }
  }
  return out;
}

// What messages call the bodies of a scene.
const char* name_of_bodies(const Composition& composition) {
  if (!composition.has_width()) return "needles";
  return composition.are_spheres() ? "spheres" : "rods";
}

// Inelastic walls, of which the messages are those of inelastic pairs.
std::vector<std::string> wall_warnings(const Scene& scene) {
  std::vector<std::string> list;
  const char* const bodies = name_of_bodies(scene.composition());
  const double tc = scene.collisions.tc.value_or(scene.collisions.tc_relative.value_or(0));
  const std::array<double, 3>& gravity = scene.forces.gravity;
  for (const Scene::Wall& wall : scene.walls) {
    const std::string key = fmt::format("walls.epsilon = {} of {}", wall.epsilon, name_of(wall));
    // Where needles slide, hits have a t_c rule of their own.
    if (wall.epsilon < 1 && tc == 0 && !scene.collisions.sliding) {
      list.push_back(fmt::format(
          "{}: {} can hit an inelastic wall infinitely often in a finite time, which ends a run; "
          "set collisions.tc_relative, such as 1e-3, to prevent it",
          key, bodies));
    } else if (wall.epsilon == 0 && gravity != std::array<double, 3>{}) {
      list.push_back(fmt::format(
          "{}: t_c cannot prevent collapse at epsilon = 0, where {} that fall do not rebound", key,
          bodies));
    }
  }
  return list;
}

std::vector<std::string> driving_warnings(const Scene& scene) {
  const auto& kicks = scene.driving.kicks;
  if (!kicks || kicks->translational > 0 || kicks->rotational > 0) return {};
  return {"driving.kicks: translational = rotational = 0: kicks change no velocity"};
}

std::vector<std::string> collision_warnings(const Scene& scene) {
  std::vector<std::string> list;
  const Scene::Collisions& c = scene.collisions;
  const Composition composition = scene.composition();
  const char* const bodies = name_of_bodies(composition);
  const double tc = c.tc.value_or(c.tc_relative.value_or(0));
  const char* tc_key = c.tc ? "tc" : "tc_relative";
  const std::vector<Rule> rules = rules_of(scene, composition);
  const auto any = [&](auto&& holds) {
    return std::ranges::any_of(rules, [&](const Rule& rule) { return holds(rule.restitution); });
  };
  const bool walls_bounce =
      std::ranges::any_of(scene.walls, [](const Scene::Wall& wall) { return wall.epsilon < 1; });
  const bool bounces =
      walls_bounce || any([](const Restitution& rule) { return rule.epsilon < 1; });
  for (const Rule& rule : rules) {
    if (!(rule.restitution.epsilon < 1 && tc == 0) || c.sliding) continue;
    list.push_back(fmt::format(
        "{}: inelastic {} can collide infinitely often in a finite time, which ends a run; set "
        "collisions.tc_relative, such as 1e-3, to prevent it",
        rule.epsilon, bodies));
  }
  if (any([](const Restitution& rule) { return rule.epsilon == 0; }) && tc > 0)
    list.push_back(fmt::format(
        "collisions.{} = {}: cannot prevent collapse at epsilon = 0, where {} do not rebound",
        tc_key, tc, bodies));
  if (bounces && c.tc_relative && tc > 0 && tc < 1e-7)
    list.push_back(fmt::format(
        "collisions.tc_relative = {}: below about 1e-7 rebounds are too small to be resolved, and "
        "collapse is not prevented",
        tc));
  if (c.tc_relative && tc >= long_contact && (composition.is_inelastic() || walls_bounce))
    list.push_back(fmt::format("collisions.tc_relative = {}: {}", tc, effect_of_long_contact));
  if (!c.sliding && c.sliding_below != Scene::Collisions().sliding_below)
    list.push_back(
        fmt::format("collisions.sliding_below = {}: has no effect without collisions.sliding",
                    c.sliding_below));
  if (!bounces && !composition.is_rough() && tc > 0)
    list.push_back(
        fmt::format("collisions.{} = {}: has no effect on elastic smooth {}", tc_key, tc, bodies));
  return list;
}

std::vector<std::string> until_warnings(const Scene& scene) {
  std::vector<std::string> list;
  const auto ratio = scene.until.energy_ratio;
  if (ratio && *ratio >= 1)
    list.push_back(fmt::format("until.energy_ratio = {}: is met from the start", *ratio));
  if (ratio && *ratio < 1 && !scene.composition().is_inelastic() && !exchanges_energy(scene))
    list.push_back(fmt::format(
        "until.energy_ratio = {}: is never met, as collisions keep the energy", *ratio));
  return list;
}

std::vector<std::string> output_warnings(const Scene& scene) {
  std::vector<std::string> list;
  const Scene::Output& output = scene.output;
  const bool frames = output.frames_per_decade || !output.frame_times.empty();
  const char* lost = frames                        ? "frames"
                     : output.frames_every         ? "frames_every"
                     : output.events               ? "events"
                     : !output.observables.empty() ? "observables"
                     : output.series_every         ? "series_every"
                     : output.grid                 ? "grid"
                     : output.size_classes         ? "size_classes"
                                                   : nullptr;
  if (output.file.empty() && lost)
    list.push_back(fmt::format("output.{}: nothing is written without output.file", lost));
  if (scene.until.time && !output.frame_times.empty() &&
      output.frame_times.back() > *scene.until.time)
    list.push_back(fmt::format("output.frames: the frame at {} lies behind until.time = {}",
                               output.frame_times.back(), *scene.until.time));
  return list;
}

std::vector<std::string> size_warnings(const Scene::Engine& engine) {
  std::vector<std::string> list;
  const auto unused = [&](const char* key, double size) {
    list.push_back(fmt::format("engine.{} = {}: has no effect on engine.search = {}", key, size,
                               engine.search));
  };
  if (engine.cell_side && engine.search == "all-pairs") unused("cell_side", *engine.cell_side);
  if (engine.capsule_radius && engine.search != "auto" && engine.search != "capsules")
    unused("capsule_radius", *engine.capsule_radius);
  return list;
}

}  // namespace

std::vector<std::string> accuracy_warnings(const Scene::Engine& engine) {
  std::vector<std::string> list;
  const bool rigorous = engine.accuracy == "rigorous";
  const bool sampled = engine.isolation == "sampling";
  if (engine.sampling_step && !sampled)
    list.push_back(
        fmt::format("engine.sampling_step = {}: has no effect without engine.isolation = sampling",
                    *engine.sampling_step));
  if (engine.root_tolerance && engine.escalation.value_or(rigorous ? "always" : "") == "always")
    list.push_back(fmt::format(
        "engine.root_tolerance = {}: has no effect where every root is refined in double-double",
        *engine.root_tolerance));
  if (engine.filter && (engine.search == "linked-lists" || engine.search == "all-pairs"))
    list.push_back(fmt::format("engine.filter = {}: has no effect on engine.search = {}",
                               *engine.filter, engine.search));
  if (rigorous && (sampled || engine.isolation == "bounds" ||
                   (engine.escalation && *engine.escalation != "always")))
    list.push_back(fmt::format(
        "engine.accuracy = rigorous: engine.{} takes away what makes it so",
        engine.isolation && engine.isolation != "intervals" ? "isolation" : "escalation"));
  return list;
}

std::vector<std::string> warnings(const Scene& scene) {
  std::vector<std::string> list;
  const auto add = [&](std::vector<std::string> more) {
    list.insert(list.end(), more.begin(), more.end());
  };
  const Composition composition = scene.composition();
  for (const Species& species : composition.species()) {
    if (species.k >= 2 || species.diameter > 0) continue;
    list.push_back(
        fmt::format("{} = {}{}: below 2, where all mass sits at the tips, mass lies beyond them",
                    scene.species.empty() ? "needles.k" : "species.k", species.k,
                    composition.is_mixture() ? " of " + printable(species.name) : ""));
  }
  const bool at_rest = std::ranges::all_of(composition.species(), [](const Species& species) {
    return species.t_tr == 0 && species.t_rot == 0;
  });
  if (scene.initial.file.empty() && at_rest && !is_pushed(scene)) {
    list.push_back("initial.t_tr, initial.t_rot = 0: nothing moves");
  }
  add(collision_warnings(scene));
  add(wall_warnings(scene));
  add(driving_warnings(scene));
  add(until_warnings(scene));
  add(output_warnings(scene));
  add(size_warnings(scene.engine));
  add(accuracy_warnings(scene.engine));
  return list;
}

std::string place_of(const Scene& scene, std::string_view key, std::string_view value) {
  const auto found = scene.places.find(key);
  return found == scene.places.end() ? fmt::format("{} = {}", key, value) : found->second;
}

}  // namespace needlework
