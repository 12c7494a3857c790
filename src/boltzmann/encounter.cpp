#include "src/boltzmann/encounter.h"

#include <cmath>
#include <limits>

#include "needlework/error.h"
#include "src/physics/collision.h"
#include "src/physics/director.h"

namespace needlework::boltzmann {
namespace {

// A train of bounces is as long as the contact over t_c; one of so many is not worth its time.
constexpr std::uint64_t most_collisions = 1'000'000;

FreeNeedle free_needle(const kernels::Flight& flight, const Body& body, double direction) {
  const auto array = [](const Vec3d& a) { return std::array{a.x, a.y, a.z}; };
  return {array(flight.r), array(flight.u), array(flight.v * direction),
          array(flight.w * direction), 2 * body.half_length};
}

void fly(kernels::Flight& flight, double time) {
  flight.r = kernels::centre_after(flight, time);
  flight.u = normalised(kernels::director_after(flight, time));
  flight.w = project_out(flight.w, flight.u);
  kernels::set_rotation(flight);
}

}  // namespace

Touching touching(const std::array<Vec3d, 2>& v, const std::array<Vec3d, 2>& u,
                  const std::array<Vec3d, 2>& w, const std::array<double, 2>& arm) {
  Touching out;
  out.arm = arm;
  for (int i = 0; i < 2; ++i) {
    kernels::Flight& flight = out.needle[i];
    flight.r = u[i] * -arm[i];
    flight.v = v[i];
    flight.u = u[i];
    flight.w = project_out(w[i], u[i]);
    kernels::set_rotation(flight);
  }
  return out;
}

std::optional<FirstContact> Encounter::next_contact(const Touching& pair, double direction) const {
  try {
    return predict(free_needle(pair.needle[0], bodies_[0], direction),
                   free_needle(pair.needle[1], bodies_[1], direction),
                   std::numeric_limits<double>::max(), true);
  } catch (const InputError&) {
    // Needles that turn near each other for very long.
    return std::nullopt;
  }
}

void Encounter::collide(Touching& pair, const Restitution& rule) const {
  kernels::Flight &a = pair.needle[0], &b = pair.needle[1];
  const Vec3d across = cross(a.u, b.u);
  kernels::ContactGeometry contact;
  contact.u_first = a.u;
  contact.u_second = b.u;
  contact.sin_angle = std::sqrt(dot(across, across));
  contact.normal = normalised(across);
  contact.arm_first = pair.arm[0];
  contact.arm_second = pair.arm[1];
  const Vec3d v = a.v - b.v + cross(a.w, a.u) * pair.arm[0] - cross(b.w, b.u) * pair.arm[1];
  const int side = dot(v, contact.normal) > 0 ? -1 : 1;
  const CollidingPair both{a.v, a.w, b.v, b.w, bodies_[0], bodies_[1], contact, side};
  const Impact impact = rule.is_rough() ? needlework::collide<Surface::rough>(both, rule)
                                        : needlework::collide<Surface::smooth>(both, rule);
  a.v = impact.v_first, a.w = project_out(impact.w_first, a.u);
  b.v = impact.v_second, b.w = project_out(impact.w_second, b.u);
  kernels::set_rotation(a);
  kernels::set_rotation(b);
}

bool Encounter::is_first(const Touching& pair) const {
  const auto contact = next_contact(pair, -1);
  return contact && std::isinf(contact->time);
}

EncounterResult Encounter::follow(Touching& pair) const {
  EncounterResult out;
  for (bool inelastic = true;;) {
    collide(pair, inelastic ? rule_ : Restitution{});
    ++out.collisions;
    if (!inelastic) ++out.tc_collisions;
    const auto next = next_contact(pair, 1);
    if (!next || out.collisions == most_collisions) {
      out.finished = false;
      return out;
    }
    if (std::isinf(next->time)) return out;
    for (kernels::Flight& needle : pair.needle) fly(needle, next->time);
    pair.arm = {next->arm_first, next->arm_second};
    inelastic = next->time >= contact_time_;
  }
}

}  // namespace needlework::boltzmann
