#include "src/cli/report.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "needlework/initial_state.h"
#include "src/cli/json.h"
#include "src/json/results.h"
#include "src/observe/forecast.h"
#include "src/runs/exact_rates.h"
#include "src/runs/loaded_scene.h"
#include "src/runs/resources.h"
#include "src/scene/accuracy.h"
#include "src/scene/confinement.h"

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

}  // namespace

double Report::collision_rate() const { return ratio(collisions_per_needle(), result.last.time); }

double Report::collision_rate_error() const {
  return 2 * result.system_rate.standard_error / static_cast<double>(scene.needles.count);
}

double Report::collision_rate_exact() const {
  if (!result.theory_holds) return undefined;
  return runs::equilibrium_rate(scene, result.initial.energy);
}

double Report::collisions_per_needle() const {
  return ratio(2 * static_cast<double>(result.last.collisions),
               static_cast<double>(scene.needles.count));
}

double Report::us_per_collision() const {
  return ratio(1e6 * result.loop.cpu(), static_cast<double>(result.collisions));
}

std::vector<double> Report::pair_rates_exact() const {
  if (!scene.composition().is_mixture() || !result.theory_holds) return {};
  return runs::equilibrium_rates_by_pair(scene, result.initial.energy);
}

MixtureTheory::MixtureTheory(const Composition& composition, double volume,
                             std::vector<theory::Temperatures> initial)
    : composition_(composition), volume_(volume), initial_(std::move(initial)), curve_(begin()) {}

const std::vector<theory::Temperatures>& MixtureTheory::at(double time) {
  const auto [place, is_new] = known_.try_emplace(time);
  if (!is_new) return place->second;
  if (time < time_) curve_ = begin();
  time_ = time;
  return place->second = curve_.at(time);
}

namespace {

// Species scatter around the temperatures they are drawn with, which many needles do little.
std::vector<theory::Temperatures> drawn_temperatures(const Scene& scene) {
  constexpr std::uint64_t many = 1000000;
  runs::LoadedScene drawn{.scene = scene, .initial = {}};
  if (scene.needles.count <= many) drawn.initial = draw_initial_state(scene);
  return runs::temperatures_by_species(drawn);
}

}  // namespace

std::optional<std::vector<theory::Temperatures>> Report::species_theory_at(
    const Totals& sample) const {
  const Composition composition = scene.composition();
  // Theory of rods holds at low density alone, which would look like a deviation of the run.
  if (!runs::has_mixture_theory(composition) || composition.has_width() ||
      runs::beyond_cooling_theory(composition) || !scene.initial.file.empty() ||
      acts_on_single_needles(scene) || !(result.initial.energy > 0) || !result.theory_holds) {
    return std::nullopt;
  }
  if (!mixture_theory) {
    mixture_theory.emplace(composition, runs::volume_of(scene), drawn_temperatures(scene));
  }
  const auto& found = mixture_theory->at(sample.time);
  if (!std::isfinite(theory::mean_of_species(composition, found).energy())) return std::nullopt;
  return found;
}

double Report::initial_collision_rate() const {
  const Composition composition = scene.composition();
  if (composition.is_needle_gas()) {
    return theory::collision_rate(runs::theory_density_of(scene),
                                  {result.initial.t_tr, result.initial.t_rot}, composition[0].k);
  }
  return runs::initial_collision_rate({.scene = scene, .initial = {}});
}

std::optional<theory::Temperatures> Report::theory_at(const Totals& sample) const {
  if (const auto each = species_theory_at(sample)) {
    return theory::mean_of_species(scene.composition(), *each);
  }
  if (!scene.composition().is_needle_gas() || !scene.initial.file.empty() ||
      acts_on_single_needles(scene) || !(result.initial.energy > 0) || !result.theory_holds) {
    return std::nullopt;
  }
  const Composition composition = scene.composition();
  const Restitution& rule = composition.restitution(0, 0);
  const theory::Gas gas{composition[0].k, rule.epsilon, rule.beta};
  const double tau = theory_time_scale(runs::theory_density_of(scene)) * sample.time;
  return theory::cooling_curve(gas, {result.initial.t_tr, result.initial.t_rot}, std::span(&tau, 1))
      .front();
}

std::string stop_name(const runs::RunResult& result) {
  if (result.failure) return "invalid_state";
  return name_of(result.stop);
}

std::string json_of(const Report& report) {
  const Totals& last = report.result.last;
  const runs::Stopwatch& loop = report.result.loop;
  const Scene& scene = report.scene;
  const Simulation& simulation = report.simulation;
  Json json;
  json["needles"] = scene.needles.count;
  json::add_numbers(json, last);
  json["events"] = simulation.counters().events;
  json["collisions_per_needle"] = number(report.collisions_per_needle());
  json["collision_rate"] = number(report.collision_rate());
  json["collision_rate_error"] = number(report.collision_rate_error());
  json["collision_rate_exact"] = number(report.collision_rate_exact());
  json["energy_initial"] = number(report.result.initial.energy);
  if (!scene.species.empty()) json::add_species(json, simulation);
  if (simulation.composition().has_width()) json::add_rods(json, scene, simulation);
  if (!scene.walls.empty()) json::add_walls(json, simulation);
  if (acts_on_single_needles(scene)) json::add_energy_budget(json, simulation);
  json::add_contacts(json, simulation);
  json::add_growth(json, simulation);
  json::add_stress(json, simulation);
  json["theory"] = nullptr;
  if (const auto theory = report.theory_at(last)) {
    json["theory"] = {{"energy", number(theory->energy())},
                      {"t_tr", number(theory->t_tr)},
                      {"t_rot", number(theory->t_rot)}};
  }
  if (const auto each = report.species_theory_at(last)) {
    Json& species = json["theory"]["species"] = Json::array();
    for (std::size_t n = 0; n < each->size(); ++n) {
      species.push_back({{"name", simulation.composition()[n].name},
                         {"t_tr", number((*each)[n].t_tr)},
                         {"t_rot", number((*each)[n].t_rot)}});
    }
  }
  json["setup_s"] = report.setup_s;
  json["wall_s"] = loop.wall();
  json["cpu_s"] = loop.cpu();
  json["total_s"] = runs::seconds_since_launch();
  json["collisions_per_s"] =
      number(ratio(static_cast<double>(report.result.collisions), loop.wall()));
  json["us_per_collision"] = number(report.us_per_collision());
  json["peak_rss_bytes"] = runs::peak_memory();
  json["threads"] = scene.engine.threads.value_or(1);
  json["isa"] = simulation.isa();
  json["search"] = simulation.search();
  json["queue"] = simulation.queue();
  json["accuracy"] = accuracy_name(scene.engine);
  json["effects"] = simulation.effects();
  json["trajectory_hash"] = simulation.trajectory_hash();
  json["seed"] = scene.needles.seed;
  json["version"] = NEEDLEWORK_VERSION;
  json["stop"] = stop_name(report.result);
  json["title"] = scene.title;
  if (!simulation.placement().empty()) json["placement"] = simulation.placement();
  json["file"] = scene.output.file.empty() ? Json(nullptr) : Json(scene.output.file);
  json["stats"] = stats_of(simulation.counters());
  return json_text(json, 2);
}

}  // namespace needlework::cli
