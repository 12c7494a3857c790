#include "src/serve/species_json.h"

#include <cmath>
#include <utility>

#include "src/composition/pair_name.h"
#include "src/runs/contact_share.h"
#include "src/runs/rod_totals.h"

namespace needlework::serve {
namespace {

using Json = nlohmann::ordered_json;

// Infinity and NaN, which JSON does not have, become null.
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

}  // namespace

void add_species(Json& json, const Simulation& simulation) {
  const Composition& composition = simulation.composition();
  const auto totals = simulation.species_totals();
  const auto collisions = simulation.collisions_by_pair();
  Json species = Json::array(), by_pair = Json::object();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    species.push_back({{"name", composition[a].name},
                       {"count", totals[a].count},
                       {"t_tr", number_or_null(totals[a].t_tr)},
                       {"t_rot", number_or_null(totals[a].t_rot)}});
    for (std::size_t b = a; b < composition.size(); ++b) {
      by_pair[pair_name(composition, a, b)] = collisions[composition.pair_index(a, b)];
    }
  }
  json["species"] = std::move(species);
  json["collisions_by_pair"] = std::move(by_pair);
}

void add_walls(Json& json, const Simulation& simulation) {
  Json walls = Json::array();
  for (const WallTotals& wall : simulation.wall_totals()) {
    walls.push_back({{"axis", axis_name(wall)},
                     {"side", side_name(wall)},
                     {"hits", wall.hits},
                     {"impulse", number_or_null(wall.impulse)},
                     {"pressure", number_or_null(wall.pressure(simulation.time()))}});
  }
  json["walls"] = std::move(walls);
}

void add_energy_budget(Json& json, const Simulation& simulation) {
  Json& budget = json["energy_budget"];
  simulation.energy_budget().for_each(
      [&](const char* name, const auto& energy) { budget[name] = energy; });
}

void add_contacts(Json& json, const Simulation& simulation) {
  const auto contacts = simulation.sliding_contacts();
  if (!contacts) return;
  json["contacts"] = {{"entered", contacts->entered},
                      {"ended_by_force", contacts->ended_by_force},
                      {"ended_by_tip", contacts->ended_by_tip},
                      {"ended_by_strike", contacts->ended_by_strike},
                      {"crowded", contacts->crowded},
                      {"time", number_or_null(contacts->time)},
                      {"share", number_or_null(runs::contact_share(simulation, *contacts))}};
}

void add_rods(Json& json, const Scene& scene, const Simulation& simulation) {
  const runs::RodTotals rods = runs::rod_totals(scene, simulation);
  json["rods"] = {{"packing_fraction", rods.packing_fraction},
                  {"virial", rods.virial},
                  {"pressure", number_or_null(rods.pressure)},
                  {"pressure_meaning", rods.pressure_meaning}};
}

}  // namespace needlework::serve
