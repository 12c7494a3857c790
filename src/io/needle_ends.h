// The ends of needles, for files that show them as lines.
#pragma once

#include <array>
#include <vector>

#include "needlework/state.h"
#include "src/box/own_numbers.h"
#include "src/box/tilt.h"

namespace needlework::io {

/// The tail of each needle, then its tip; in a sheared box centres are within its tilted cell.
/// `lengths` are those of the species, where needles have none of their own [L].
inline std::vector<std::array<double, 3>> ends_of(const State& state,
                                                  const std::vector<double>& lengths) {
  std::vector<std::array<double, 3>> ends;
  const TiltedCell cell(state);
  ends.reserve(2 * state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double length = number_at(state, i, &OwnBodies::length, lengths);
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
    const double radius = 0.5 * number_at(state, i, &OwnBodies::diameter, diameters);
    radii.insert(radii.end(), {radius, radius});
  }
  return radii;
}

/// A number of each needle, at its tail and at its tip.
inline std::vector<double> at_both_ends(const std::vector<double>& rows) {
  std::vector<double> out;
  out.reserve(2 * rows.size());
  for (const double number : rows) out.insert(out.end(), {number, number});
  return out;
}

}  // namespace needlework::io
