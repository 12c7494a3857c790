// What results say of rods of finite width: how much room they take up, and their pressure.
#pragma once

#include "needlework/scene.h"
#include "needlework/simulation.h"

namespace needlework::runs {

struct RodTotals {
  double packing_fraction = 0;  ///< share of the box that they take up
  double virial = 0;            ///< Simulation::virial()
  /// The mean over the run, by observe::Pressure; NaN at the start. [energy / L^3]
  double pressure = 0;
  const char* pressure_meaning = "";  ///< observe::Pressure::meaning()
};

/// Of a simulation of this scene.
RodTotals rod_totals(const Scene& scene, const Simulation& simulation);

}  // namespace needlework::runs
