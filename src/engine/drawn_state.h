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

}  // namespace needlework
