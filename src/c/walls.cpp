// What C callers learn of the walls of a simulation, of contacts, and of where its energy has come
// from.
#include <numeric>
#include <string>

#include "src/c/handle.h"
#include "src/runs/contact_share.h"

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
    const WallTotals& found = walls[index];
    *wall = {.axis = found.axis,
             .high = found.high,
             .hits = found.hits,
             .impulse = found.impulse,
             .normal_impulse = found.normal_impulse,
             .area = found.area,
             .phase = found.phase,
             .energy = self.run.simulation().energy_budget().walls.at(index)};
  });
}

int needlework_get_contacts(needlework_simulation* simulation, needlework_contacts* contacts) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(contacts, "contacts");
    const Simulation& gas = self.run.simulation();
    const auto counted = gas.sliding_contacts();
    const SlidingContacts found = counted.value_or(SlidingContacts{});
    *contacts = {.entered = found.entered,
                 .ended_by_force = found.ended_by_force,
                 .ended_by_tip = found.ended_by_tip,
                 .ended_by_strike = found.ended_by_strike,
                 .crowded = found.crowded,
                 .time = found.time,
                 .share = counted ? runs::contact_share(gas, found) : 0};
  });
}

int needlework_get_energy_budget(needlework_simulation* simulation,
                                 needlework_energy_budget* budget) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(budget, "budget");
    const EnergyBudget found = self.run.simulation().energy_budget();
    *budget = {.pairs = found.pairs,
               .walls = std::accumulate(found.walls.begin(), found.walls.end(), 0.0),
               .thermostat = found.thermostat.value_or(0),
               .kicks = found.kicks.value_or(0),
               .velocities_set = found.velocities_set,
               .gravity = found.gravity.value_or(0)};
  });
}
