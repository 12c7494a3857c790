#include "kernels/sliding_pair.h"

#include <cmath>

namespace needlework::kernels {

SlidingContact sliding_contact(const SlidingBodies& bodies, const SlidingState& state) {
  const Vec3d &u1 = state.u_first, &u2 = state.u_second, &w1 = state.w_first, &w2 = state.w_second;
  const Vec3d x = cross(u1, u2), turn1 = cross(w1, u1), turn2 = cross(w2, u2);
  const double square = dot(x, x);
  SlidingContact out;
  out.sin_angle = std::sqrt(square);
  out.normal = x * (1 / out.sin_angle);
  out.gap = dot(state.r, out.normal);
  out.arm_first = dot(cross(u2, state.r), x) / square;
  out.arm_second = dot(cross(u1, state.r), x) / square;
  const Vec3d relative = state.v + (turn1 * out.arm_first - turn2 * out.arm_second);
  out.speed = dot(relative, out.normal);
  const double squares1 = out.arm_first * out.arm_first / bodies.first.inertia;
  const double squares2 = out.arm_second * out.arm_second / bodies.second.inertia;
  out.inverse = (1 / bodies.first.mass + 1 / bodies.second.mass) + (squares1 + squares2);

  // f'' = (f'' in free flight) + |u1 x u2| M_nn lambda.
  const double turning = dot(w1, w1) + dot(w2, w2);
  const double bent = 2 * dot(state.v, cross(turn1, u2) + cross(u1, turn2)) +
                      dot(state.r, 2 * cross(turn1, turn2) - turning * x);
  const double pressed = 1 / (out.sin_angle * out.inverse);
  out.force = -bent * pressed;
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
