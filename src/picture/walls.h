// Walls around needles as a picture shows them, and the part of space that it has to show.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"
#include "src/picture/camera.h"

namespace needlework::picture {

enum class WallKind { resting, moving, thermal };

/// What a picture calls walls of this kind.
const char* name_of(WallKind kind);

/// A wall at one time.
struct WallSurface {
  std::size_t axis = 0;  ///< to which it is normal
  bool is_high = false;  ///< at the high edge of the box
  WallKind kind = WallKind::resting;
  double place = 0;  ///< of its surface, along its axis [L]
};

/// Where the walls are in this state, at this time since the start of the scene; without a time,
/// in the middle of a motion that shakes them. Each wall is of one side, not of both.
std::vector<WallSurface> surfaces_of(std::span<const Scene::Wall> walls, const State& state,
                                     std::optional<double> time);

/// Axis and side, what is special about the wall, and its restitution, in words.
std::string description_of(const Scene::Wall& wall);

/// The box, tilted if it is sheared, and, along axes that are not periodic, all centres and
/// surfaces beyond it.
Region region_of(const State& state, std::span<const WallSurface> walls);

/// Whether a side of the box is open: there is a wall at the other end of its axis only.
bool is_open(std::span<const WallSurface> walls, std::size_t axis, bool high);

}  // namespace needlework::picture
