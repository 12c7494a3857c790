// Gases in which no two needles can ever collide, as their state shows.
//
// A contact is a change of sign of r . (u1 x u2); see docs/physics.md. That is 0 for ever where all
// directors stay parallel, and for needles that stay in one plane; those in parallel planes do not
// touch at all. Only planes normal to an axis count, which rounding keeps to the last bit.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "kernels/vec3.h"

namespace needlework {

/// Velocity, director and angular velocity of a needle.
struct Motion {
  Vec3d v, u, w;
};

/// Why there are no collisions.
enum class Collisionless { parallel, normal_to_x, normal_to_y, normal_to_z };

/// What all needles do then: "are parallel and do not rotate".
const char* words_for(Collisionless reason);

/// Whether the motion stays in a plane normal to this axis.
inline bool stays_normal_to(int axis, const Motion& motion) {
  const auto along = [&](const Vec3d& a) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; };
  Vec3d across = motion.w;
  (axis == 0 ? across.x : axis == 1 ? across.y : across.z) = 0;
  return along(motion.u) == 0 && along(motion.v) == 0 && across == Vec3d{};
}

/// Nothing if needles may collide, for all that motion(i) of each of `count` needles shows. That is
/// known after a few needles if their motions have nothing in common.
template <class MotionOf>
std::optional<Collisionless> collisionless(std::size_t count, MotionOf&& motion) {
  using enum Collisionless;
  const auto all = [&](const auto& holds) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!holds(motion(i))) return false;
    }
    return count > 0;
  };
  const auto is_parallel = [u = count > 0 ? motion(0).u : Vec3d{}](const Motion& a) {
    return a.w == Vec3d{} && (a.u == u || a.u == -u);
  };
  if (all(is_parallel)) return parallel;
  constexpr std::array planes{normal_to_x, normal_to_y, normal_to_z};
  for (int axis = 0; axis < 3; ++axis) {
    if (all([&](const Motion& a) { return stays_normal_to(axis, a); })) return planes[axis];
  }
  return std::nullopt;
}

}  // namespace needlework
