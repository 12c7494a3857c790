// Drawn initial states.
#pragma once

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework {

/// Draws an initial state: centres and directors uniform, velocities Gaussian, total momentum 0
/// (N >= 2), temperatures exactly as asked for. Rods of finite width are placed one by one where
/// they overlap no other or, where there is too little room for that, on a lattice from which
/// elastic collisions move them, or with smaller sizes from which they grow
/// (Scene::Initial::packing). A pure function of the scene's seed, the
/// same on every machine. Throws InputError for a count, box, temperature or property of needles
/// that a scene file could not hold (docs/scenes.md gives their ranges), and for rods for which no
/// room is found.
State draw_initial_state(const Scene& scene);

/// How draw_initial_state() is expected to place the rods of a scene.
struct PlannedPlacement {
  enum class Way { inserted, on_lattice, grown };

  Way way = Way::inserted;
  double tries = 0;       ///< of each rod that is inserted, on average, or about so many
  double collisions = 0;  ///< of each rod that is moved from its place on a lattice, or that grows
};
/// Throws InputError where draw_initial_state() would find no room, as far as that can be known
/// before.
PlannedPlacement plan_placement(const Scene& scene);

}  // namespace needlework
