#include "src/json/results.h"

#include "src/composition/pair_name.h"
#include "src/runs/rod_totals.h"

namespace needlework::json {

using Json = nlohmann::ordered_json;

namespace {

Json drawn_json(const Distribution& drawn) {
  Json out{{"distribution", name_of(drawn.shape)}};
  for (const auto& [name, value] : {std::pair("mean", drawn.mean),
                                    {"width", drawn.width},
                                    {"min", drawn.least},
                                    {"max", drawn.greatest},
                                    {"exponent", drawn.exponent}}) {
    if (value) out[name] = *value;
  }
  return out;
}

Json spread_json(const Spread& spread, Json drawn) {
  return {{"mean", spread.mean},
          {"width", spread.width},
          {"least", spread.least},
          {"greatest", spread.greatest},
          {"drawn", std::move(drawn)}};
}

}  // namespace

Json k_of(const Species& species) {
  if (species.fixed) return nullptr;
  return species.sizes && species.has_axis() ? species.sizes->k.mean : species.k;
}

void add_sizes(Json& json, const Species& species) {
  if (species.fixed) json["fixed"] = true;
  if (!species.sizes) return;
  const Sizes& sizes = *species.sizes;
  const DrawnSizes& drawn = species.drawn;
  Json& all = json["sizes"] = Json::object();
  const auto add = [&](const char* name, const Spread& spread,
                       const std::optional<Distribution>& its, const char* rule = "",
                       const std::optional<double>& number = {}) {
    if (spread.is_one() && !its && !number) return;
    all[name] = spread_json(spread, number ? Json{{rule, *number}}
                                    : its  ? drawn_json(*its)
                                           : Json());
  };
  add("length", sizes.length, drawn.length);
  add("diameter", sizes.diameter, drawn.diameter, "aspect", drawn.aspect);
  if (species.fixed) return;
  add("mass", sizes.mass, drawn.mass, "density", drawn.density);
  if (!species.turns()) return;
  add("k", sizes.k, drawn.k);
  add("inertia", sizes.inertia, drawn.inertia);
}

void add_species(Json& json, const Simulation& simulation) {
  const Composition& composition = simulation.composition();
  const auto totals = simulation.species_totals();
  const auto collisions = simulation.collisions_by_pair();
  Json species = Json::array(), by_pair = Json::object();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    Json& each = species.emplace_back(Json{{"name", composition[a].name}});
    add_numbers(each, totals[a]);
    add_sizes(each, composition[a]);
    for (std::size_t b = a; b < composition.size(); ++b) {
      by_pair[pair_name(composition, a, b)] = collisions[composition.pair_index(a, b)];
    }
  }
  json["species"] = std::move(species);
  json["collisions_by_pair"] = std::move(by_pair);
}

Json motion_of(const Scene::WallMotion& motion) {
  if (motion.tangential) return {{"tangential", *motion.tangential}};
  if (motion.velocity) {
    Json out{{"velocity", *motion.velocity}};
    if (motion.stop_at) out["stop_at"] = *motion.stop_at;
    return out;
  }
  return {
      {"amplitude", motion.amplitude}, {"frequency", motion.frequency}, {"phase", motion.phase}};
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

void add_growth(Json& json, const Simulation& simulation) {
  if (const auto growth = simulation.growth()) add_numbers(json["growth"], *growth);
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
