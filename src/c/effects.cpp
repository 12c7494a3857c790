// What C callers learn of effects: walls, contacts, and where the energy has come from.
#include <string>

#include "src/c/handle.h"
#include "src/c/numbers.h"
#include "src/runs/rod_totals.h"

using namespace needlework;

size_t needlework_wall_count(needlework_simulation* simulation) {
  size_t count = 0;
  c::guarded(simulation, [&](needlework_simulation& self) {
    count = self.run.simulation().wall_totals().size();
  });
  return count;
}

int needlework_get_wall(needlework_simulation* simulation, size_t index, needlework_wall* wall) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(wall, "wall");
    const auto walls = self.run.simulation().wall_totals();
    if (index >= walls.size()) {
      throw c::UsageError("index = " + std::to_string(index) + ": expected that of one of " +
                          std::to_string(walls.size()) + " walls");
    }
    wall->axis = walls[index].axis;
    wall->high = walls[index].high;
    c::copy_numbers(walls[index], *wall, &needlework_wall::hits);
  });
}

int needlework_get_contacts(needlework_simulation* simulation, needlework_contacts* contacts) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(contacts, "contacts");
    const auto counted = self.run.simulation().sliding_contacts();
    c::copy_numbers(counted.value_or(SlidingContacts{}), *contacts, &needlework_contacts::entered);
  });
}

int needlework_get_growth(needlework_simulation* simulation, needlework_growth* growth) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(growth, "growth");
    const Simulation& source = self.run.simulation();
    GrowthTotals at_rest;
    at_rest.packing_fraction = runs::rod_totals(self.run.scene(), source).packing_fraction;
    c::copy_numbers(source.growth().value_or(at_rest), *growth, &needlework_growth::scale);
  });
}

int needlework_get_pressure_tensor(needlework_simulation* simulation,
                                   needlework_pressure_tensor* tensor) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(tensor, "tensor");
    c::copy_numbers(self.run.simulation().stress().value_or(StressTotals{}), *tensor,
                    &needlework_pressure_tensor::kinetic_xx);
  });
}

int needlework_get_energy_budget(needlework_simulation* simulation,
                                 needlework_energy_budget* budget) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(budget, "budget");
    c::copy_numbers(self.run.simulation().energy_budget().complete(), *budget,
                    &needlework_energy_budget::pairs);
  });
}
