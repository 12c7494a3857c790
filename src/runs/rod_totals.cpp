#include "src/runs/rod_totals.h"

#include "src/observe/pressure.h"

namespace needlework::runs {

observe::RodTotals rod_totals(const Scene& scene, const Simulation& simulation) {
  const auto box = simulation.box();
  const double volume = box[0] * box[1] * box[2];
  const observe::Pressure pressure(scene);
  const observe::PressureSums now = observe::pressure_sums(
      simulation.time(), simulation.t_tr_integral(), simulation.virial(), simulation.wall_totals());
  const auto growth = simulation.growth();
  return {.packing_fraction =
              growth ? growth->packing_fraction : simulation.composition().packing_fraction(volume),
          .virial = now.virial,
          .pressure = pressure.between({}, now),
          .pressure_meaning = pressure.meaning()};
}

}  // namespace needlework::runs
