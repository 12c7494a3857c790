// Room and pressure of rods, of a simulation as it is.
#pragma once

#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "src/observe/rod_totals.h"

namespace needlework::runs {

/// Of a simulation of this scene; the pressure is the mean over the run.
observe::RodTotals rod_totals(const Scene& scene, const Simulation& simulation);

}  // namespace needlework::runs
