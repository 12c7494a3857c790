#include <algorithm>
#include <vector>

#include "needlework/scene.h"

namespace needlework {

std::vector<Scene::WallSide> Scene::wall_sides() const {
  std::vector<WallSide> out;
  for (std::size_t n = 0; n < walls.size(); ++n) {
    const Wall& wall = walls[n];
    if (wall.axis.size() != 1 || wall.axis < "x" || wall.axis > "z") continue;  // refused elsewhere
    const auto axis = static_cast<std::size_t>(wall.axis[0] - 'x');
    if (wall.side != "high") out.push_back({axis, false, n});
    if (wall.side != "low") out.push_back({axis, true, n});
  }
  return out;
}

std::array<bool, 3> Scene::periodic() const {
  std::array<bool, 3> out{true, true, true};
  for (const WallSide& side : wall_sides()) out[side.axis] = false;
  return out;
}

bool Scene::has_moving_walls() const {
  return std::ranges::any_of(walls, [](const Wall& wall) {
    return wall.motion && wall.motion->velocity.value_or(0) != 0;
  });
}

}  // namespace needlework
