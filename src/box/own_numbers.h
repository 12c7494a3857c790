// Numbers of bodies, row by row of a state.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "needlework/state.h"

namespace needlework {

/// Columns of own numbers with their names.
inline std::array<std::pair<const char*, const std::vector<double>*>, 4> named_columns(
    const OwnBodies& own) {
  return {{{"length", &own.length},
           {"diameter", &own.diameter},
           {"mass", &own.mass},
           {"inertia", &own.inertia}}};
}

/// A number of the body in row i: its own or, where it has none, that of its species.
inline double number_at(const State& state, std::size_t i, std::vector<double> OwnBodies::*own,
                        const std::vector<double>& of_species) {
  const std::vector<double>& rows = state.own_bodies.*own;
  if (!rows.empty()) return rows[i];
  return of_species.at(state.species.empty() ? 0 : state.species[i]);
}

}  // namespace needlework
