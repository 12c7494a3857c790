#include "src/audit/touch.h"

#include <cmath>

#include "src/audit/tolerances.h"

namespace needlework::audit {

RelativeState relative_state(const Record& first, const Record& second, const Vector<double>& r12) {
  const auto director = [](const Record& record) {
    const Vector<Extended> u = to<Extended>(record.u);
    return u * (1 / norm(u));
  };
  RelativeState out{to<Extended>(r12), to<Extended>(first.v) - to<Extended>(second.v),
                    director(first),   {},
                    director(second),  {}};
  out.du1 = cross(to<Extended>(first.w), out.u1);
  out.du2 = cross(to<Extended>(second.w), out.u2);
  return out;
}

Touch::Touch(const RelativeState& state, const std::array<AuditedBody, 2>& bodies) {
  const auto& [r, v, u1, du1, u2, du2] = state;
  const Vector<Extended> x = cross(u1, u2), dx = cross(du1, u2) + cross(u1, du2);
  const Extended xx = dot(x, x);
  sine = norm(x);
  n = x * (1 / sine);
  arms = {dot(cross(u2, r), x) / xx, dot(cross(u1, r), x) / xx};
  velocity = v + du1 * arms[0] - du2 * arms[1];
  normal_velocity = dot(velocity, n);
  inverse_mass = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    inverse_mass += bodies[i].inverse_mass<Extended>() +
                    arms[i] * arms[i] * bodies[i].inverse_inertia<Extended>();
  }
  const Extended omega1 = norm(du1), omega2 = norm(du2), omega = omega1 + omega2;
  const Extended length = (Extended(bodies[0].length) + bodies[1].length) / 2;
  speeds = norm(v) + omega * length;
  free_acceleration = 2 * (dot(v, dx) + dot(r, cross(du1, du2))) / sine;
  noise = contact_noise * (2 * norm(v) + norm(r) * omega) * omega / sine;
  const auto slip = [&](const Vector<Extended>& u) {
    return std::abs(dot(cross(u, velocity), n)) / sine;
  };
  const auto spin = [&](const Vector<Extended>& u, const Vector<Extended>& du) {
    return std::abs(dot(cross(u, du), n)) / sine;
  };
  rate = omega + 2 * slip(u2) / bodies[0].length + 2 * slip(u1) / bodies[1].length + spin(u1, du1) +
         spin(u2, du2);
}

// The impulse turns the first director along n, and the second one against it.
RelativeState after_change(const RelativeState& state, const std::array<AuditedBody, 2>& bodies,
                           const Touch& touch, Extended change) {
  const Vector<Extended> impulse = touch.n * (change / touch.inverse_mass);
  RelativeState out = state;
  out.v =
      out.v + impulse * (bodies[0].inverse_mass<Extended>() + bodies[1].inverse_mass<Extended>());
  out.du1 = out.du1 + impulse * (touch.arms[0] * bodies[0].inverse_inertia<Extended>());
  out.du2 = out.du2 - impulse * (touch.arms[1] * bodies[1].inverse_inertia<Extended>());
  return out;
}

}  // namespace needlework::audit
