// States of few needles, for tests of pictures.
#pragma once

#include <array>
#include <vector>

#include "needlework/state.h"

namespace needlework::picture {

/// Needles along x at rest, in a cube.
inline State needles_at(double box, const std::vector<std::array<double, 3>>& centres) {
  State state;
  state.box = {box, box, box};
  state.position = centres;
  state.velocity.resize(centres.size());
  state.angular_velocity.resize(centres.size());
  state.orientation.resize(centres.size(), {1, 0, 0});
  return state;
}

}  // namespace needlework::picture
