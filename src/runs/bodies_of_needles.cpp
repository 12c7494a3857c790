#include "src/runs/bodies_of_needles.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace needlework::runs {

OwnBodies bodies_of_needles(const Simulation& simulation) {
  OwnBodies out = simulation.own_bodies();
  if (!out.empty()) return out;
  const Composition& composition = simulation.composition();
  const std::vector<std::uint8_t> species = simulation.species();
  for (std::size_t i = 0; i < simulation.needles(); ++i) {
    const Species& body = composition[species.empty() ? 0 : species[i]];
    out.length.push_back(body.length);
    out.diameter.push_back(body.diameter);
    out.mass.push_back(body.mass_or_infinity());
    out.inertia.push_back(body.inertia_or_infinity());
  }
  return out;
}

}  // namespace needlework::runs
