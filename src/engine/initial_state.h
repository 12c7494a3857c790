// Drawn initial states, and how they were made.
#pragma once

#include <string>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework {

struct DrawnState {
  State state;
  std::string placement;  ///< how rods have found room; empty for needles
};

/// See draw_initial_state().
DrawnState draw_state(const Scene& scene);

/// How draw_state() is expected to place the rods of a scene.
struct PlannedPlacement {
  bool on_lattice = false;
  double tries = 0;       ///< of each rod that is inserted, on average, or about so many
  double collisions = 0;  ///< of each rod that is moved from its place on a lattice
};
/// Throws InputError where draw_state() would find no room, as far as that can be known before.
PlannedPlacement plan_placement(const Scene& scene);

}  // namespace needlework
