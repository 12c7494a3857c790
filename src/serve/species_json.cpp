#include "src/serve/species_json.h"

#include <cmath>
#include <utility>

#include "src/composition/pair_name.h"

namespace needlework::serve {

void add_species(nlohmann::ordered_json& json, const Simulation& simulation) {
  using Json = nlohmann::ordered_json;
  // Infinity and NaN, which JSON does not have, become null.
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  const Composition& composition = simulation.composition();
  const auto totals = simulation.species_totals();
  const auto collisions = simulation.collisions_by_pair();
  Json species = Json::array(), by_pair = Json::object();
  for (std::size_t a = 0; a < composition.size(); ++a) {
    species.push_back({{"name", composition[a].name},
                       {"count", totals[a].count},
                       {"t_tr", number(totals[a].t_tr)},
                       {"t_rot", number(totals[a].t_rot)}});
    for (std::size_t b = a; b < composition.size(); ++b) {
      by_pair[pair_name(composition, a, b)] = collisions[composition.pair_index(a, b)];
    }
  }
  json["species"] = std::move(species);
  json["collisions_by_pair"] = std::move(by_pair);
}

}  // namespace needlework::serve
