#include "src/json/results.h"

#include "src/composition/pair_name.h"
#include "src/runs/rod_totals.h"

namespace needlework::json {

using Json = nlohmann::ordered_json;

void add_species(Json& json, const Simulation& simulation) {
  const Composition& composition = simulation.composition();
  const auto totals = simulation.species_totals();
  const auto collisions = simulation.collisions_by_pair();
  Json species = Json::array(), by_pair = Json::object();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    Json& each = species.emplace_back(Json{{"name", composition[a].name}});
    add_numbers(each, totals[a]);
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
    Json& each = walls.emplace_back(Json{{"axis", axis_name(wall)}, {"side", side_name(wall)}});
    add_numbers(each, wall);
  }
  json["walls"] = std::move(walls);
}

void add_energy_budget(Json& json, const Simulation& simulation) {
  add_numbers(json["energy_budget"], simulation.energy_budget());
}

void add_contacts(Json& json, const Simulation& simulation) {
  if (const auto contacts = simulation.sliding_contacts()) add_numbers(json["contacts"], *contacts);
}

void add_stress(Json& json, const Simulation& simulation) {
  if (const auto stress = simulation.stress()) add_numbers(json["pressure_tensor"], *stress);
}

void add_rods(Json& json, const Scene& scene, const Simulation& simulation) {
  const observe::RodTotals rods = runs::rod_totals(scene, simulation);
  add_numbers(json["rods"], rods);
  json["rods"]["pressure_meaning"] = rods.pressure_meaning;
}

}  // namespace needlework::json
