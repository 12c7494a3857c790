#include "src/cli/check_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "src/cli/json.h"
#include "src/composition/pair_name.h"
#include "src/json/results.h"
#include "src/machine/available_cores.h"
#include "src/runs/duration_text.h"
#include "src/runs/engine_choice.h"
#include "src/runs/resources.h"
#include "src/runs/size_text.h"
#include "src/scene/confinement.h"
#include "src/scene/growth_plan.h"
#include "src/scene/needed_memory.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json optional_number(const std::optional<T>& x) {
  return x ? number(*x) : Json(nullptr);
}

// The key of [until] that ends a run.
const char* condition_of(Stop stop) {
  switch (stop) {
    case Stop::collisions:
      return "collisions_per_needle";
    case Stop::energy:
      return "energy_ratio";
    default:
      return "time";
  }
}

std::string line(const char* name, const std::string& text) {
  return fmt::format("  {:<16}{}\n", name, text);
}

// Of a needle of this species at the start. Both needles of a collision count it.
double mean_free_time_of(const runs::Explanation& e, const Composition& composition,
                         std::size_t species) {
  double collisions = 0;
  for (std::size_t other = 0; other < composition.size(); ++other) {
    const double rate = e.counted_rates[composition.pair_index(species, other)];
    collisions += species == other ? 2 * rate : rate;
  }
  return static_cast<double>(composition[species].count) / collisions;
}

Json species_json(const runs::Explanation& e, const Composition& composition) {
  Json out = Json::array();
  for (std::size_t n = 0; n < composition.size(); ++n) {
    const Species& each = composition[n];
    out.push_back({{"name", each.name},
                   {"count", each.count},
                   {"length", each.length},
                   {"diameter", each.diameter},
                   {"mass", number(each.mass_or_infinity())},
                   {"k", json::k_of(each)},
                   {"t_tr", number(e.by_species[n].t_tr)},
                   {"t_rot", number(e.by_species[n].t_rot)}});
    json::add_sizes(out.back(), each);
    if (!composition.is_mixture()) continue;
    out.back()["mean_free_time"] =
        e.rates.empty() || each.fixed ? Json() : number(mean_free_time_of(e, composition, n));
  }
  return out;
}

Json pairs_json(const runs::Explanation& e, const Composition& composition) {
  Json out = Json::object();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const std::size_t pair = composition.pair_index(a, b);
      const Restitution& rule = composition.restitution(a, b);
      out[pair_name(composition, a, b)] = {
          {"epsilon", rule.epsilon},
          {"beta", rule.beta},
          {"collisions_per_time", e.rates.empty() ? Json() : number(e.rates[pair])}};
      if (!composition.meets(a, b)) out[pair_name(composition, a, b)]["meet"] = false;
    }
  }
  return out;
}

std::string start_text(const runs::Explanation& e) {
  const Scene::Initial& initial = e.scene.initial;
  const std::string from = initial.file.empty()
                               ? fmt::format("drawn, seed {}", e.scene.needles.seed)
                               : "read from " + initial.file;
  return fmt::format("{}; T_tr = {:.6g}, T_rot = {:.6g}, E = {:.6g} per needle{}", from,
                     e.initial.t_tr, e.initial.t_rot, e.initial.energy(),
                     e.scene.composition().has_fixed() ? " that moves" : "");
}

std::string collision_text(const Restitution& c) {
  const std::string normal = c.epsilon < 1 ? "inelastic" : "elastic";
  const std::string tangential = c.beta == -1  ? "smooth"
                                 : c.beta == 1 ? "perfectly rough"
                                               : "rough";
  return fmt::format("{} (epsilon = {:g}), {} (beta = {:g})", normal, c.epsilon, tangential,
                     c.beta);
}

// Of a species as its bodies are on average.
std::string body_text(const Species& species) {
  if (species.fixed) return fmt::format("of length {:g}, fixed", species.length);
  return fmt::format("of length {:g} and mass {:g}{}", species.length, species.mass,
                     species.sizes ? " on average" : "");
}

// Properties and temperatures of each species, and how often they collide at the start.
std::string species_lines(const runs::Explanation& e, const Composition& composition) {
  std::string text;
  const char* title = "needles";
  for (std::size_t n = 0; n < composition.size(); ++n) {
    const Species& species = composition[n];
    text += line(title, fmt::format("{}, {}, species \"{}\" {}", species.count,
                                    runs::shape_text(species), species.name, body_text(species)));
    title = "";
    for (const std::string& size : runs::size_lines(species)) text += line("", size);
    if (!composition.is_mixture() || species.fixed) continue;
    text += line("", fmt::format("at T_tr = {:.6g}, T_rot = {:.6g}{}", e.by_species[n].t_tr,
                                 e.by_species[n].t_rot,
                                 e.rates.empty() || species.count == 0
                                     ? ""
                                     : fmt::format(", mean free time {:.4g}",
                                                   mean_free_time_of(e, composition, n))));
  }
  return text;
}

// The rule of [collisions], then those of pairs of species that differ from it.
std::string collision_lines(const Scene& scene, const Composition& composition) {
  const Restitution usual{scene.collisions.epsilon, scene.collisions.beta};
  std::string text = line("collisions", collision_text(usual));
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const Restitution& rule = composition.restitution(a, b);
      const bool meet = composition.meets(a, b);
      const bool both_fixed = composition[a].fixed && composition[b].fixed;
      if ((meet && rule == usual) || both_fixed) continue;
      text += line("", fmt::format("{}: {}", pair_name(composition, a, b),
                                   meet ? collision_text(rule) : "pass through each other"));
    }
  }
  return text;
}

std::string contact_time_text(const Scene::Collisions& c) {
  if (c.tc) return fmt::format("on, {:g}", *c.tc);
  if (c.tc_relative) return fmt::format("on, {:g} of the present mean free time", *c.tc_relative);
  return "off";
}

const char* name_of_axis(const Scene::WallSide& side) {
  return side.axis == 0 ? "x" : side.axis == 1 ? "y" : "z";
}
const char* name_of_side(const Scene::WallSide& side) { return side.is_high ? "high" : "low"; }

std::string wall_text(const Scene::Wall& wall) {
  if (wall.temperature) {
    const std::string thermal = fmt::format("thermal, at temperature {:g}", *wall.temperature);
    if (!wall.motion || !wall.motion->tangential) return thermal;
    const auto [first, second] = *wall.motion->tangential;
    const bool is_x = wall.axis == "x", is_z = wall.axis == "z";
    return thermal + fmt::format(", slides at {:g} along {} and {:g} along {}", first,
                                 is_x ? "y" : "x", second, is_z ? "y" : "z");
  }
  std::string text = wall.epsilon < 1 ? fmt::format("inelastic (epsilon = {:g})", wall.epsilon)
                                      : "elastic (epsilon = 1)";
  if (!wall.motion) return text;
  const Scene::WallMotion& motion = *wall.motion;
  if (motion.velocity) {
    text += fmt::format(", moves at {:g} along {}", *motion.velocity, wall.axis);
    return motion.stop_at ? text + fmt::format(" until it stops at {:g}", *motion.stop_at) : text;
  }
  return text + fmt::format(", moves by {:g} sin(2 pi {:g} t + {:g})", motion.amplitude,
                            motion.frequency, motion.phase);
}

// Of densities.
const char* unit_of_volume(const Composition& composition) {
  if (composition.longest() == 1) return "unit of volume";
  const bool differ = composition.is_mixture() || composition.has_own_sizes();
  // Of rods with their caps.
  if (composition.has_width())
    return differ ? "cube of the longest extent" : "cube of their extent";
  return differ ? "cube of the longest length" : "cube of their length";
}

// How dense the gas becomes, and when walls have no more room for it.
std::string motion_line(const runs::Explanation& e) {
  if (!e.motion || !std::isfinite(e.motion->time)) return {};
  const runs::ExplainedMotion& motion = *e.motion;
  const Composition composition = e.scene.composition();
  const double length = composition.longest();
  std::string text = fmt::format(
      "at time {:.6g}: {:.4g} needles per {}", motion.time,
      static_cast<double>(e.scene.needles.count) * (length * length * length) / motion.volume,
      unit_of_volume(composition));
  if (composition.has_width())
    text +=
        fmt::format(", {:.4g} of the box taken up", composition.packing_fraction(motion.volume));
  if (motion.meeting && motion.meeting->time == motion.time)
    text += fmt::format("; then the walls along {} leave no more room, and the run ends",
                        "xyz"[motion.meeting->axis]);
  return line("", text);
}

std::string wall_lines(const runs::Explanation& e) {
  std::string text;
  for (const runs::ExplainedWall& wall : e.walls) {
    std::string about = fmt::format("{}-{}: {}", name_of_axis(wall.side), name_of_side(wall.side),
                                    wall_text(e.scene.walls[wall.side.entry]));
    if (std::isfinite(wall.stop)) about += fmt::format(", at time {:.6g}", wall.stop);
    if (std::isfinite(wall.hits))
      about += fmt::format("; at the start {:.4g} hits per time", wall.hits);
    if (std::isfinite(wall.force)) about += fmt::format(", mean force {:.4g}", wall.force);
    text += line(text.empty() ? "walls" : "", about);
  }
  return text + motion_line(e);
}

std::string gravity_lines(const runs::Explanation& e) {
  std::string text;
  for (const runs::ExplainedGravity& along : e.gravity) {
    if (text.empty()) {
      text = line("gravity", fmt::format("({:g})", fmt::join(e.scene.forces.gravity, ", ")));
    }
    const char axis = "xyz"[along.axis];
    text +=
        line("", along.scale_heights.empty()
                     ? fmt::format("along {}, which is periodic: thermal walls brake with N m g "
                                   "= {:.4g} in the steady state",
                                   axis, along.weight)
                     : fmt::format("along {}: weight N m g = {:.4g}, scale height T / (m g) = "
                                   "{:.4g} at the start",
                                   axis, along.weight, fmt::join(along.scale_heights, ", ")));
  }
  return text;
}

Json gravity_json(const runs::Explanation& e) {
  Json out = Json::array();
  for (const runs::ExplainedGravity& along : e.gravity) {
    Json heights = Json::array();
    for (const double height : along.scale_heights) heights.push_back(number(height));
    out.push_back({{"axis", std::string(1, "xyz"[along.axis])},
                   {"weight", number(along.weight)},
                   {"scale_heights", std::move(heights)}});
  }
  return out;
}

std::string driving_lines(const runs::Explanation& e) {
  std::string text;
  const auto& [kicks, andersen, growth] = e.scene.driving;
  if (kicks) {
    text += line("driving",
                 fmt::format("kicks every {:g}, translational {:g}, rotational {:g}: energy {:.4g} "
                             "per needle and time",
                             kicks->every, kicks->translational, kicks->rotational, e.kick_power));
  }
  if (andersen) {
    text += line(text.empty() ? "driving" : "",
                 fmt::format("thermostat at temperature {:g}, rate {:g} of redraws of each needle",
                             andersen->temperature, andersen->rate));
  }
  if (growth) {
    const GrowthPlan plan = growth_plan(e.scene, e.scene.composition(), e.scene.needles.box);
    std::string end;
    const auto add = [&](const std::string& limit) { end += (end.empty() ? "" : " or ") + limit; };
    if (growth->until_packing)
      add(fmt::format("a packing fraction of {:g}", *growth->until_packing));
    if (growth->until_pressure) add(fmt::format("P V / (N T) = {:g}", *growth->until_pressure));
    if (end.empty()) end = "they jam";
    text += line("driving",
                 fmt::format("all bodies grow, by a rate of {:g}, until {}, to at most {:.6g} of "
                             "their sizes{}",
                             growth->rate, end, plan.largest,
                             plan.end == Stop::no_room ? ", as the box has no room for more" : ""));
  }
  return text;
}

std::string shear_lines(const runs::Explanation& e) {
  if (!e.scene.shear) return {};
  std::string text =
      line("shear", fmt::format("rate {:g}, the row of boxes above slides by {:.4g} in a time of 1",
                                e.scene.shear->rate, e.scene.shear->rate * e.scene.needles.box[1]));
  if (!e.steady) return text;
  return text + line("", fmt::format("steady at low density with T_tr = {:.4g}, T_rot = {:.4g}, "
                                     "reached in some {:.2g} collisions per body",
                                     e.steady->t_tr, e.steady->t_rot, e.steady->collisions));
}

Json shear_json(const runs::Explanation& e) {
  Json out{{"rate", e.scene.shear->rate}, {"offset", e.scene.shear->offset}, {"steady", nullptr}};
  if (e.steady) {
    out["steady"] = {{"t_tr", number(e.steady->t_tr)},
                     {"t_rot", number(e.steady->t_rot)},
                     {"collisions_per_needle", number(e.steady->collisions)}};
  }
  return out;
}

const char* method_of(const runs::Explanation& e) {
  if (e.placing->way == PlannedPlacement::Way::inserted) return "insertion";
  if (e.placing->way == PlannedPlacement::Way::grown) return "compress";
  return e.scene.initial.packing == "crossed" ? "crossed" : "lattice";
}

std::string placing_text(const runs::Explanation& e) {
  const auto& [way, tries, collisions] = *e.placing;
  const std::string how =
      way == PlannedPlacement::Way::grown
          ? fmt::format("smaller, then grown in about {:.2g} elastic collisions each", collisions)
      : way == PlannedPlacement::Way::on_lattice
          ? fmt::format("{}, then {} elastic collisions each",
                        e.scene.initial.packing == "crossed" ? "in crossed blocks" : "on a lattice",
                        collisions)
          : fmt::format("one by one, in about {:.2g} tries each", tries);
  return fmt::format("{}; about {}", how, runs::duration_text(e.placing_seconds));
}

Json placing_json(const runs::Explanation& e) {
  const auto& [way, tries, collisions] = *e.placing;
  const bool is_inserted = way == PlannedPlacement::Way::inserted;
  return {{"method", method_of(e)},
          {"tries_per_rod", is_inserted ? number(tries) : Json()},
          {"collisions_per_rod", is_inserted ? Json() : number(collisions)},
          {"wall_s", number(e.placing_seconds)}};
}

Json walls_json(const runs::Explanation& e) {
  Json out = Json::array();
  for (const runs::ExplainedWall& wall : e.walls) {
    const Scene::Wall& given = e.scene.walls[wall.side.entry];
    Json motion;
    if (given.motion) {
      motion = json::motion_of(*given.motion);
    }
    out.push_back({{"axis", name_of_axis(wall.side)},
                   {"side", name_of_side(wall.side)},
                   {"epsilon", given.temperature ? Json() : Json(given.epsilon)},
                   {"temperature", optional_number(given.temperature)},
                   {"motion", std::move(motion)},
                   {"stop_time", number(wall.stop)},
                   {"hits_per_time", number(wall.hits)},
                   {"force", number(wall.force)}});
  }
  return out;
}

Json motion_json(const runs::Explanation& e) {
  const auto& [meeting, time, volume] = *e.motion;
  Json out{{"meet", nullptr}, {"time", number(time)}, {"volume", number(volume)}};
  if (meeting)
    out["meet"] = {{"axis", std::string(1, "xyz"[meeting->axis])}, {"time", number(meeting->time)}};
  return out;
}

Json driving_json(const runs::Explanation& e) {
  Json out = Json::object();
  if (const auto& kicks = e.scene.driving.kicks) {
    out["kicks"] = {{"every", kicks->every},
                    {"translational", kicks->translational},
                    {"rotational", kicks->rotational},
                    {"energy_per_needle_and_time", number(e.kick_power)}};
  }
  if (const auto& andersen = e.scene.driving.andersen) {
    out["andersen"] = {{"rate", andersen->rate}, {"temperature", andersen->temperature}};
  }
  if (const auto& growth = e.scene.driving.growth) {
    const GrowthPlan plan = growth_plan(e.scene, e.scene.composition(), e.scene.needles.box);
    out["growth"] = {{"rate", growth->rate},
                     {"until_packing", optional_number(growth->until_packing)},
                     {"until_pressure", optional_number(growth->until_pressure)},
                     {"largest", plan.largest},
                     {"largest_by", name_of(plan.end)}};
  }
  return out;
}

std::string until_text(const Scene& scene) {
  const Scene::Until& until = scene.until;
  std::vector<std::string> conditions;
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) conditions.push_back(fmt::format("{} = {:g}", name, *value));
  };
  add("time", until.time);
  add("collisions_per_needle", until.collisions_per_needle);
  add("energy_ratio", until.energy_ratio);
  add("wall_s", until.wall_s);
  if (scene.driving.growth) conditions.emplace_back("the end of growth");
  // 2 collisions / N, whether or not they move.
  const bool counts_fixed = until.collisions_per_needle && scene.composition().has_fixed();
  return fmt::format("{}{}", fmt::join(conditions, " or "),
                     counts_fixed ? fmt::format(", of all {} needles", scene.needles.count) : "");
}

std::string expected_text(const runs::Explanation& e) {
  if (!e.expected && is_pushed(e.scene)) {
    return fmt::format("not known: the theory of a gas that cools does not apply to {}",
                       e.scene.shear ? "uniform shear" : "walls, gravity and driving");
  }
  const char* beyond = runs::beyond_cooling_theory(e.scene.composition());
  if (!e.expected && beyond && e.scene.composition().is_inelastic()) {
    return fmt::format("not known: the theory of a gas that cools does not apply to {}", beyond);
  }
  if (!e.expected) {
    return e.scene.until.wall_s ? "runs until wall_s is over" : "never ends, as far as theory goes";
  }
  if (!std::isfinite(e.expected->time)) {
    return fmt::format("{} is not met before time 1e308: a gas that cools collides ever less often",
                       condition_of(e.expected->stop));
  }
  return fmt::format(
      "{} is met first, at time {:.3g} with E/E(0) = {:.3g}, after about {:.3g} "
      "collisions ({:.3g} per needle){}",
      condition_of(e.expected->stop), e.expected->time, e.expected->energy_ratio, e.collisions,
      e.expected->collisions_per_needle, beyond ? ", at the rate of the start" : "");
}

std::string exact_rate_text(const runs::Explanation& e, const Composition& composition) {
  const std::string text = fmt::format("{:.6g} per needle and time, in equilibrium of {} needles",
                                       e.rate_exact, composition.count() - composition.fixed());
  if (!composition.has_fixed()) return text;
  return text + fmt::format(" that move among {} fixed, which count, too", composition.fixed());
}

std::string engine_text(const runs::Explanation& e) {
  return fmt::format("search {}, calendar {}, accuracy {}, {}, threads {}", e.search, e.calendar,
                     e.accuracy, e.isa, runs::threads_text(e.scene));
}

Json json_of(const AvailableCores& cores) {
  return {{"usable", cores.usable()},
          {"online", cores.online},
          {"affinity", cores.affinity},
          {"quota", optional_number(cores.quota)},
          {"quota_file", cores.quota ? Json(cores.quota_file.string()) : Json(nullptr)},
          {"slurm_cpus_per_task", cores.slurm_per_task ? Json(*cores.slurm_per_task) : Json()}};
}

std::string output_text(const Scene::Output& output) {
  if (output.file.empty()) return "none";
  std::string text =
      output.series_every
          ? fmt::format("{}, a series of samples every {:g}, ", output.file, *output.series_every)
          : fmt::format("{}, a series of {:g} samples per decade of time, ", output.file,
                        output.series_per_decade);
  if (output.size_classes) text += fmt::format("{} classes by size, ", *output.size_classes);
  if (!output.observables.empty()) text += fmt::format("{}, ", fmt::join(output.observables, ", "));
  if (output.frames_every) {
    text += fmt::format("a frame every {:g}", *output.frames_every);
  } else if (output.frames_per_decade) {
    text += fmt::format("{:g} frames per decade", *output.frames_per_decade);
  } else if (!output.frame_times.empty()) {
    text += fmt::format("{} frames and the first and last", output.frame_times.size());
  } else {
    text += "the first and the last frame";
  }
  return text + (output.events ? ", every collision" : "");
}

}  // namespace

std::string json_of(const runs::Explanation& e) {
  const Scene& scene = e.scene;
  const Composition composition = scene.composition();
  // Of several species those of no single one.
  const bool one = !composition.is_mixture();
  const auto of_one = [&](double value) { return one ? Json(value) : Json(); };
  Json json;
  json["title"] = scene.title;
  json["needles"] = scene.needles.count;
  json["box"] = scene.needles.box;
  json["density"] = e.density;
  if (composition.has_width()) {
    const auto& box = scene.needles.box;
    json["packing_fraction"] = composition.packing_fraction(box[0] * box[1] * box[2]);
  }
  if (e.placing) json["placing"] = placing_json(e);
  json["k"] = one ? json::k_of(composition[0]) : Json();
  json["seed"] = scene.needles.seed;
  json["t_tr"] = e.initial.t_tr;
  json["t_rot"] = e.initial.t_rot;
  json["energy"] = e.initial.energy();
  json["mean_free_time"] = number(e.mean_free_time);
  json["collision_rate_exact"] = number(e.rate_exact);
  json["epsilon"] = of_one(composition.restitution(0, 0).epsilon);
  json["beta"] = of_one(composition.restitution(0, 0).beta);
  if (!scene.species.empty()) json["species"] = species_json(e, composition);
  if (!one) json["pairs"] = pairs_json(e, composition);
  json["tc"] = optional_number(scene.collisions.tc);
  json["tc_relative"] = optional_number(scene.collisions.tc_relative);
  if (scene.collisions.sliding) {
    json["sliding_below"] = scene.collisions.sliding_below;
    json["elastic_strikes"] = scene.collisions.elastic_strikes;
  }
  if (!e.walls.empty()) json["walls"] = walls_json(e);
  if (e.motion) json["moving_walls"] = motion_json(e);
  if (!e.gravity.empty()) {
    json["gravity"] = scene.forces.gravity;
    json["falling"] = gravity_json(e);
  }
  if (scene.shear) json["shear"] = shear_json(e);
  if (scene.driving.kicks || scene.driving.andersen || scene.driving.growth)
    json["driving"] = driving_json(e);
  json["until"] = {{"time", optional_number(scene.until.time)},
                   {"collisions_per_needle", optional_number(scene.until.collisions_per_needle)},
                   {"energy_ratio", optional_number(scene.until.energy_ratio)},
                   {"wall_s", optional_number(scene.until.wall_s)}};
  json["expected"] = nullptr;
  if (e.expected) {
    json["expected"] = {{"stop", condition_of(e.expected->stop)},
                        {"time", number(e.expected->time)},
                        {"collisions", number(e.collisions)},
                        {"collisions_per_needle", number(e.expected->collisions_per_needle)},
                        {"energy_ratio", number(e.expected->energy_ratio)},
                        {"wall_s", number(e.seconds)}};
  }
  json["search"] = e.search;
  json["queue"] = e.calendar;
  json["accuracy"] = e.accuracy;
  json["threads"] = e.threads;
  json["isa"] = e.isa;
  json["cores"] = json_of(available_cores());
  json["memory_bytes"] = number(e.memory);
  json["available_bytes"] = number(runs::available_memory());
  json["warnings"] = e.warnings;
  return json_text(json, 2);
}

std::string text_of(const runs::Explanation& e) {
  const Scene& scene = e.scene;
  const auto& box = scene.needles.box;
  std::string text = scene.title.empty() ? "" : scene.title + "\n";
  const Composition composition = scene.composition();
  if (scene.species.empty()) {
    text += line("needles",
                 fmt::format("{}, {}", scene.needles.count, runs::shape_text(composition[0])));
  }
  if (!scene.species.empty()) text += species_lines(e, composition);
  text += line("box", fmt::format("{:g} x {:g} x {:g}, {:.4g} needles per {}", box[0], box[1],
                                  box[2], e.density, unit_of_volume(composition)));
  if (composition.has_width()) {
    const bool overlap = std::ranges::any_of(composition.species(), &Species::overlap);
    text += line("packing", fmt::format("{:.4g} of the box is taken up by bodies{}",
                                        composition.packing_fraction(box[0] * box[1] * box[2]),
                                        overlap ? ", where they overlap more than once" : ""));
  }
  text += line("start", start_text(e));
  if (e.placing) text += line("placing", placing_text(e));
  text += line(
      "mean free time",
      fmt::format("{:.4g}{}{}{}", e.mean_free_time,
                  composition.has_fixed() ? " of needles that move" : "",
                  composition.has_width() ? ", that of low density" : "",
                  composition.has_own_sizes() ? ", of bodies that are as those on average" : ""));
  if (std::isfinite(e.rate_exact)) text += line("exact rate", exact_rate_text(e, composition));
  text += collision_lines(scene, composition);
  text += line("t_c rule", contact_time_text(scene.collisions));
  if (scene.collisions.sliding) {
    text +=
        line("sliding", fmt::format("on, below flights of {:g} of the present mean free time{}",
                                    scene.collisions.sliding_below,
                                    scene.collisions.elastic_strikes ? ", elastic strikes" : ""));
  }
  text += wall_lines(e);
  text += gravity_lines(e);
  text += shear_lines(e);
  text += driving_lines(e);
  text += line("ends", until_text(scene));
  text += line("expected", expected_text(e));
  text += line("engine", engine_text(e));
  text += line("cores", available_cores().text());
  text += line("output", output_text(scene.output));
  text += line("memory", fmt::format("about {} of {}", bytes_text(e.memory),
                                     bytes_text(runs::available_memory())));
  if (std::isfinite(e.seconds))
    text += line("wall time", "about " + runs::duration_text(e.seconds));
  return text;
}

}  // namespace needlework::cli
