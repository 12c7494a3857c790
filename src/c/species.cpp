// What C callers learn of the species of a simulation.
#include <algorithm>
#include <string>

#include "src/c/handle.h"
#include "src/c/numbers.h"
#include "src/runs/bodies_of_needles.h"
#include "src/runs/rod_totals.h"

using namespace needlework;

namespace {

void require_species(const Composition& composition, const char* name, size_t index) {
  if (index < composition.size()) return;
  throw c::UsageError(std::string(name) + " = " + std::to_string(index) + ": expected " +
                      (composition.is_mixture()
                           ? "an index of a species, below " + std::to_string(composition.size())
                           : "0, the only species"));
}

}  // namespace

const char* needlework_species_name(needlework_simulation* simulation, size_t index) {
  const char* name = nullptr;
  c::guarded(simulation, [&](needlework_simulation& self) {
    const Composition& composition = self.run.simulation().composition();
    if (index < composition.size()) name = composition[index].name.c_str();
  });
  return name;
}

int needlework_get_species(needlework_simulation* simulation, size_t index,
                           needlework_species* species) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(species, "species");
    const Simulation& source = self.run.simulation();
    require_species(source.composition(), "index", index);
    const Species& body = source.composition()[index];
    const SpeciesTotals totals = source.species_totals()[index];
    *species = {.count = totals.count,
                .length = body.length,
                .mass = body.mass_or_infinity(),
                .k = body.k,
                .t_tr = totals.t_tr,
                .t_rot = totals.t_rot};
  });
}

int needlework_get_species_shape(needlework_simulation* simulation, size_t index, double* diameter,
                                 double* inertia) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    const Composition& composition = self.run.simulation().composition();
    require_species(composition, "index", index);
    const Species& body = composition[index];
    if (diameter) *diameter = body.diameter;
    if (inertia) *inertia = body.inertia_or_infinity();
  });
}

int needlework_get_rods(needlework_simulation* simulation, needlework_rods* rods) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(rods, "rods");
    c::copy_numbers(runs::rod_totals(self.run.scene(), self.run.simulation()), *rods,
                    &needlework_rods::packing_fraction);
  });
}

int needlework_get_species_pair(needlework_simulation* simulation, size_t first, size_t second,
                                needlework_species_pair* pair) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(pair, "pair");
    const Simulation& source = self.run.simulation();
    const Composition& composition = source.composition();
    require_species(composition, "first", first);
    require_species(composition, "second", second);
    const Restitution& rule = composition.restitution(first, second);
    *pair = {.epsilon = rule.epsilon,
             .beta = rule.beta,
             .collisions = source.collisions_by_pair()[composition.pair_index(first, second)]};
  });
}

int needlework_species_meet(needlework_simulation* simulation, size_t first, size_t second,
                            int* meet) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(meet, "meet");
    const Composition& composition = self.run.simulation().composition();
    require_species(composition, "first", first);
    require_species(composition, "second", second);
    *meet = composition.meets(first, second);
  });
}

int needlework_get_bodies(needlework_simulation* simulation, double* length, double* diameter,
                          double* mass, double* inertia) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    const OwnBodies bodies = runs::bodies_of_needles(self.run.simulation());
    for (const auto& [column, into] : {std::pair(&bodies.length, length),
                                       {&bodies.diameter, diameter},
                                       {&bodies.mass, mass},
                                       {&bodies.inertia, inertia}}) {
      if (into) std::ranges::copy(*column, into);
    }
  });
}

int needlework_get_species_of_needles(needlework_simulation* simulation, uint8_t* species) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(species, "species");
    const Simulation& source = self.run.simulation();
    if (source.composition().is_mixture()) {
      std::ranges::copy(source.species(), species);
    } else {
      std::fill_n(species, source.needles(), 0);
    }
  });
}
