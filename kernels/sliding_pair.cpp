#include "kernels/sliding_pair.h"

#include <cmath>

#include "kernels/sliding_frame.h"

namespace needlework::kernels {

SlidingContact sliding_contact(const SlidingBodies& bodies, const SlidingState& state) {
  const Vec3d &u1 = state.u_first, &u2 = state.u_second, &w1 = state.w_first, &w2 = state.w_second;
  const SlidingFrame frame = sliding_frame(bodies, state);
  SlidingContact out;
  out.sin_angle = std::sqrt(frame.square);
  out.normal = frame.across * (1 / out.sin_angle);
  out.gap = dot(state.r, out.normal);
  out.arm_first = frame.arm_first;
  out.arm_second = frame.arm_second;
  const Vec3d relative =
      state.v + (frame.turn_first * out.arm_first - frame.turn_second * out.arm_second);
  out.speed = dot(relative, out.normal);
  out.inverse = frame.inverse;

  // f'' = (f'' in free flight) + |u1 x u2| M_nn lambda.
  const double pressed = 1 / (out.sin_angle * out.inverse);
  out.force = -frame.bent * pressed;
  const double omega1 = std::sqrt(dot(w1, w1)), omega2 = std::sqrt(dot(w2, w2));
  const double omega = omega1 + omega2;
  const double most =
      2 * std::sqrt(dot(state.v, state.v)) + std::sqrt(dot(state.r, state.r)) * omega;
  out.noise = 0x1p-48 * most * omega * pressed;

  const double slip1 = std::abs(dot(cross(u2, relative), out.normal)) / out.sin_angle;
  const double slip2 = std::abs(dot(cross(u1, relative), out.normal)) / out.sin_angle;
  const double spin = std::abs(dot(w1, out.normal)) + std::abs(dot(w2, out.normal));
  out.rate =
      omega + (slip1 / bodies.first.half + slip2 / bodies.second.half) + spin / out.sin_angle;
  return out;
}

SlidingState after_impulse(const SlidingBodies& bodies, const SlidingState& state,
                           const SlidingContact& contact, double impulse) {
  const Vec3d push = contact.normal * impulse;
  SlidingState out = state;
  out.v += push * (1 / bodies.first.mass + 1 / bodies.second.mass);
  out.w_first += cross(state.u_first, push) * (contact.arm_first / bodies.first.inertia);
  out.w_second -= cross(state.u_second, push) * (contact.arm_second / bodies.second.inertia);
  return out;
}

double sliding_energy(const SlidingBodies& bodies, const SlidingState& state) {
  const double reduced =
      bodies.first.mass * bodies.second.mass / (bodies.first.mass + bodies.second.mass);
  return (reduced * dot(state.v, state.v) +
          (bodies.first.inertia * dot(state.w_first, state.w_first) +
           bodies.second.inertia * dot(state.w_second, state.w_second))) /
         2;
}

}  // namespace needlework::kernels
