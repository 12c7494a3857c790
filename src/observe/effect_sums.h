// What the series of a gas with walls, driving or sliding contact always has.
#pragma once

#include "src/observe/observable.h"

namespace needlework::observe {

/// Hits on the walls of the scene, their impulses and pressure, and the phase of walls in motion.
ObservablePointer make_wall_sums(const Scene& scene);

/// What each effect of the scene has put into the energy of the needles.
ObservablePointer make_energy_budget(const Scene& scene);

/// Contacts of needles that slide on each other, and how they have ended.
ObservablePointer make_contact_sums();

/// Sizes, packing and pressure of bodies that grow.
ObservablePointer make_growth_sums();

}  // namespace needlework::observe
