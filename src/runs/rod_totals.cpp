#include "src/runs/rod_totals.h"

#include <limits>

namespace needlework::runs {

RodTotals rod_totals(const Scene& scene, const Simulation& simulation) {
  const auto& box = scene.needles.box;
  const double volume = box[0] * box[1] * box[2];
  const Totals now = simulation.totals();
  RodTotals out{.packing_fraction = simulation.composition().packing_fraction(volume),
                .virial = simulation.virial(),
                .pressure = std::numeric_limits<double>::quiet_NaN()};
  if (now.time > 0) {
    const double kinetic = static_cast<double>(simulation.needles()) * now.t_tr;
    out.pressure = (kinetic + out.virial / (3 * now.time)) / volume;
  }
  return out;
}

}  // namespace needlework::runs
