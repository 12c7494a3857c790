// The numbers that follow from those of a scene or a state, and the ranges in which all searches
// can follow the needles.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "needlework/scene.h"

namespace needlework {

/// A species, as far as speeds and energies go.
struct SpeciesNumbers {
  double mass = 1;        ///< [m]
  double inertia = 0;     ///< 0 of those that do not turn [m L^2]
  double v2 = 0, w2 = 0;  ///< sums over all its needles of v^2 and w^2
  double extent = 1;      ///< from end to end [L]
};

/// A gas, as far as speeds and energies go.
struct GasNumbers {
  double count = 0;  ///< number of needles
  std::vector<SpeciesNumbers> species;
  bool moves = true;        ///< whether any needle does
  bool has_cooled = false;  ///< the run has begun with more energy, so that there may be less now
};

/// Of a state that is drawn at the temperatures of the scene.
GasNumbers numbers_of_drawn(const Scene& scene);

/// The first derived number that is out of its range: "an energy of 1e300: expected at most ...".
/// Empty if all are in range.
std::string out_of_range(const GasNumbers& gas);

}  // namespace needlework
