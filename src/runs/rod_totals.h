// What results say of rods of finite width: how much room they take up, and their pressure.
#pragma once

#include "needlework/scene.h"
#include "needlework/simulation.h"

namespace needlework::runs {

struct RodTotals {
  double packing_fraction = 0;  ///< share of the box that they take up
  double virial = 0;            ///< Simulation::virial()
  /// (N T_tr + virial / (3 t)) / V, of the present temperature and of all collisions: the mean
  /// since the start where the temperature does not change. NaN at the start. [energy / L^3]
  double pressure = 0;
};

/// Of a simulation of this scene.
RodTotals rod_totals(const Scene& scene, const Simulation& simulation);

}  // namespace needlework::runs
