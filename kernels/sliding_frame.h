// What the force of a contact follows from: for all that is asked of a contact (sliding_pair.cpp),
// and for its motion, which asks for the force alone, many times (sliding_motion.cpp).
#pragma once

#include "kernels/inline.h"
#include "kernels/sliding_pair.h"

namespace needlework::kernels {

struct SlidingFrame {
  Vec3d across;                   ///< u1 x u2
  double square = 0;              ///< |u1 x u2|^2
  double arm_first = 0;           ///< s12 [L]
  double arm_second = 0;          ///< s21 [L]
  Vec3d turn_first, turn_second;  ///< w x u [1 / time]
  double inverse = 0;             ///< M_nn [1 / M]
  double turning = 0;             ///< w1^2 + w2^2 [1 / time^2]
  double bent = 0;                ///< f'' in free flight [L / time^2]
};

NEEDLEWORK_INLINE SlidingFrame sliding_frame(const SlidingBodies& bodies,
                                             const SlidingState& state) {
  const Vec3d &u1 = state.u_first, &u2 = state.u_second, &w1 = state.w_first, &w2 = state.w_second;
  SlidingFrame out;
  out.across = cross(u1, u2);
  out.square = dot(out.across, out.across);
  out.arm_first = dot(cross(u2, state.r), out.across) / out.square;
  out.arm_second = dot(cross(u1, state.r), out.across) / out.square;
  out.turn_first = cross(w1, u1);
  out.turn_second = cross(w2, u2);
  const double squares1 = out.arm_first * out.arm_first / bodies.first.inertia;
  const double squares2 = out.arm_second * out.arm_second / bodies.second.inertia;
  out.inverse = (1 / bodies.first.mass + 1 / bodies.second.mass) + (squares1 + squares2);
  out.turning = dot(w1, w1) + dot(w2, w2);
  out.bent = 2 * dot(state.v, cross(out.turn_first, u2) + cross(u1, out.turn_second)) +
             dot(state.r, 2 * cross(out.turn_first, out.turn_second) - out.turning * out.across);
  return out;
}

}  // namespace needlework::kernels
