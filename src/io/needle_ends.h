// The ends of needles, for files that show them as lines.
#pragma once

#include <array>
#include <vector>

#include "needlework/state.h"
#include "src/box/tilt.h"

namespace needlework::io {

/// The tail of each needle, then its tip; in a sheared box centres are within its tilted cell.
/// `lengths` are those of the species [L].
inline std::vector<std::array<double, 3>> ends_of(const State& state,
                                                  const std::vector<double>& lengths) {
  std::vector<std::array<double, 3>> ends;
  const TiltedCell cell(state);
  ends.reserve(2 * state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double length = lengths.at(state.species.empty() ? 0 : state.species[i]);
    for (const double s : {-0.5 * length, 0.5 * length}) {
      auto& end = ends.emplace_back(cell.position(i));
      for (std::size_t axis = 0; axis < 3; ++axis) end[axis] += s * state.orientation[i][axis];
    }
  }
  return ends;
}

/// The radius at the tail of each rod, then at its tip. `diameters` are those of the species [L].
inline std::vector<double> radii_of_ends(const State& state, const std::vector<double>& diameters) {
  std::vector<double> radii;
  radii.reserve(2 * state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double radius = 0.5 * diameters.at(state.species.empty() ? 0 : state.species[i]);
    radii.insert(radii.end(), {radius, radius});
  }
  return radii;
}

}  // namespace needlework::io
