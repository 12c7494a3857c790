#include "src/cli/report.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "src/cli/json.h"
#include "src/observe/forecast.h"
#include "src/runs/loaded_scene.h"
#include "src/runs/resources.h"
#include "src/scene/accuracy.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

double ratio(double a, double b) { return b > 0 ? a / b : undefined; }

Json stats_of(const Counters& counters) {
  Json stats;
  for (const Counters::Named& counter : Counters::all) {
    stats[counter.name] = counters.*counter.value;
  }
  stats.erase("events");  // a key of the report itself
  stats.erase("blocked");
  stats["blocked_s"] = 1e-9 * static_cast<double>(counters.blocked);
  return stats;
}

// By species and by pairs of species, in the order of the scene.
void add_species(Json& json, const Simulation& simulation) {
  const Composition& composition = simulation.composition();
  const auto totals = simulation.species_totals();
  const auto collisions = simulation.collisions_by_pair();
  json["species"] = Json::array();
  Json& by_pair = json["collisions_by_pair"] = Json::object();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    json["species"].push_back({{"name", composition[a].name},
                               {"count", totals[a].count},
                               {"t_tr", number(totals[a].t_tr)},
                               {"t_rot", number(totals[a].t_rot)}});
    for (std::size_t b = a; b < composition.size(); ++b) {
      by_pair[composition[a].name + "-" + composition[b].name] =
          collisions[composition.pair_index(a, b)];
    }
  }
}

}  // namespace

double Report::collision_rate() const { return ratio(collisions_per_needle(), course.last.time); }

double Report::collision_rate_error() const {
  return 2 * course.system_rate.standard_error / static_cast<double>(scene.needles.count);
}

double Report::collision_rate_exact() const {
  if (!runs::starts_in_equilibrium(scene) || !course.theory_holds) return undefined;
  const auto& box = scene.needles.box;
  const double count = static_cast<double>(scene.needles.count);
  const Composition composition = scene.composition();
  if (composition.is_mixture()) return undefined;
  const Species& species = composition[0];
  const double cube = species.length * species.length * species.length;
  return theory::equilibrium_rate(count, box[0] * box[1] * box[2] / cube,
                                  count * course.initial.energy, species.k) /
         (species.length * std::sqrt(species.mass));
}

double Report::collisions_per_needle() const {
  return ratio(2 * static_cast<double>(course.last.collisions),
               static_cast<double>(scene.needles.count));
}

double Report::us_per_collision() const {
  return ratio(1e6 * course.loop.cpu(), static_cast<double>(course.collisions));
}

std::optional<theory::Temperatures> Report::theory_at(const Totals& sample) const {
  if (scene.composition().is_mixture() || !scene.initial.file.empty() ||
      !(course.initial.energy > 0) || !course.theory_holds) {
    return std::nullopt;
  }
  const theory::Gas gas{scene.needles.k, scene.collisions.epsilon, scene.collisions.beta};
  const double tau = theory_time_scale(runs::theory_density_of(scene)) * sample.time;
  return theory::cooling_curve(gas, {course.initial.t_tr, course.initial.t_rot}, std::span(&tau, 1))
      .front();
}

std::string stop_name(const runs::Course& course) {
  if (course.failure) return "invalid_state";
  return name_of(course.stop);
}

std::string json_of(const Report& report) {
  const Totals& last = report.course.last;
  const runs::Stopwatch& loop = report.course.loop;
  const Scene& scene = report.scene;
  const Simulation& simulation = report.simulation;
  Json json;
  json["needles"] = scene.needles.count;
  json["collisions"] = last.collisions;
  json["events"] = simulation.counters().events;
  json["time"] = number(last.time);
  json["collisions_per_needle"] = number(report.collisions_per_needle());
  json["collision_rate"] = number(report.collision_rate());
  json["collision_rate_error"] = number(report.collision_rate_error());
  json["collision_rate_exact"] = number(report.collision_rate_exact());
  json["energy"] = number(last.energy);
  json["energy_initial"] = number(report.course.initial.energy);
  json["t_tr"] = number(last.t_tr);
  json["t_rot"] = number(last.t_rot);
  json["momentum"] = {number(last.momentum[0]), number(last.momentum[1]), number(last.momentum[2])};
  if (!scene.species.empty()) add_species(json, simulation);
  json["theory"] = nullptr;
  if (const auto theory = report.theory_at(last)) {
    json["theory"] = {{"energy", number(theory->energy())},
                      {"t_tr", number(theory->t_tr)},
                      {"t_rot", number(theory->t_rot)}};
  }
  json["setup_s"] = report.setup_s;
  json["wall_s"] = loop.wall();
  json["cpu_s"] = loop.cpu();
  json["total_s"] = runs::seconds_since_launch();
  json["collisions_per_s"] =
      number(ratio(static_cast<double>(report.course.collisions), loop.wall()));
  json["us_per_collision"] = number(report.us_per_collision());
  json["peak_rss_bytes"] = runs::peak_memory();
  json["threads"] = scene.engine.threads.value_or(1);
  json["isa"] = simulation.isa();
  json["search"] = simulation.search();
  json["queue"] = simulation.queue();
  json["accuracy"] = accuracy_name(scene.engine);
  json["effects"] = simulation.effects();
  json["tc_collisions"] = last.tc_collisions;
  json["trajectory_hash"] = simulation.trajectory_hash();
  json["seed"] = scene.needles.seed;
  json["version"] = NEEDLEWORK_VERSION;
  json["stop"] = stop_name(report.course);
  json["title"] = scene.title;
  json["file"] = scene.output.file.empty() ? Json(nullptr) : Json(scene.output.file);
  json["stats"] = stats_of(simulation.counters());
  return json_text(json, 2);
}

}  // namespace needlework::cli
