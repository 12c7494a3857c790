// Gases in which no two needles can ever collide, as their state shows.
//
// A contact is a change of sign of r . (u1 x u2); see docs/physics.md. That is 0 for ever where all
// directors stay parallel, and for needles that stay in one plane; those in parallel planes do not
// touch at all. Only planes normal to an axis count, which rounding keeps to the last bit.
#pragma once

#include <cstddef>
#include <optional>

#include "kernels/body_state.h"

namespace needlework {

/// Why there are no collisions.
enum class Collisionless {
  no_needles,
  one_needle,
  passing,  ///< all pass through each other
  alike,    ///< no motion relative to each other
  parallel,
  normal_to_x,  ///< in planes
  normal_to_y,
  normal_to_z
};

/// The reason in words: "all needles are parallel and do not rotate".
const char* words_for(Collisionless reason);

/// Whether the motion stays in a plane normal to this axis.
inline bool stays_normal_to(int axis, const kernels::BodyState& state) {
  const auto along = [&](const Vec3d& a) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; };
  Vec3d across = state.w;
  (axis == 0 ? across.x : axis == 1 ? across.y : across.z) = 0;
  return along(state.u) == 0 && along(state.v) == 0 && across == Vec3d{};
}

/// Whether all move along together, without rotation; of at least one.
template <class StateOf>
bool move_alike(std::size_t count, StateOf&& state_of) {
  const Vec3d v = state_of(0).v;
  for (std::size_t i = 0; i < count; ++i) {
    const kernels::BodyState state = state_of(i);
    if (!(state.w == Vec3d{} && state.v == v)) return false;
  }
  return true;
}

/// Nothing if needles may collide, for all that state_of(i) of each of `count` needles shows, whose
/// centres do not count. That is known after a few needles if their motions have nothing in common.
template <class StateOf>
std::optional<Collisionless> collisionless(std::size_t count, StateOf&& state_of) {
  using enum Collisionless;
  if (count < 2) return count == 0 ? no_needles : one_needle;
  const auto all = [&](const auto& holds) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!holds(state_of(i))) return false;
    }
    return true;
  };
  const kernels::BodyState first = state_of(0);
  if (move_alike(count, state_of)) return alike;
  if (all([&](const kernels::BodyState& a) {
        return a.w == Vec3d{} && (a.u == first.u || a.u == -first.u);
      })) {
    return parallel;
  }
  if (all([](const kernels::BodyState& a) { return stays_normal_to(0, a); })) return normal_to_x;
  if (all([](const kernels::BodyState& a) { return stays_normal_to(1, a); })) return normal_to_y;
  if (all([](const kernels::BodyState& a) { return stays_normal_to(2, a); })) return normal_to_z;
  return std::nullopt;
}

}  // namespace needlework
