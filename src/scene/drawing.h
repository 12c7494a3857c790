// The parts of which drawn initial states are made.
#pragma once

#include <cstdint>
#include <optional>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework {

// The scene is one that can be drawn, see src/scene/validity.h. All are pure functions of its seed.

/// Needles with their velocities: the equilibrium of an ideal gas.
State draw_needles(const Scene& scene);

/// Rods without velocities, each where it overlaps none before it: those of species that exclude
/// most come first, in order of id.
struct Insertion {
  State state;
  std::uint64_t placed = 0;  ///< how many have found a place
  std::uint64_t tries = 0;   ///< of all
};
/// Stops at the first rod that finds no place in so many tries, and where the mean number of tries
/// of all rods would become larger than `most_on_average`. Rods are placed as if they had this
/// share of their sizes.
Insertion insert_rods(const Scene& scene, std::uint64_t most_tries, double most_on_average,
                      double scale = 1);

/// All rods of a lattice along one axis, or in blocks along x, y and z in turn.
enum class RodOrder { parallel, crossed };

/// Rods without velocities, those of each species at drawn sites of a lattice; nothing if no
/// lattice has room for them.
std::optional<State> place_rods_on_lattice(const Scene& scene, RodOrder order);

/// Draws the velocities of a state of rods.
void draw_velocities(const Scene& scene, State& state);

}  // namespace needlework
