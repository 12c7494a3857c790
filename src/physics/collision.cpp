#include "src/physics/collision.h"

#include <cmath>

#include "src/physics/director.h"

namespace needlework {
namespace {

// The part of the impulse in the plane of the directors, from M_tt dp_t = -(1 + beta) V_t. The
// basis is orthonormal, because the directors themselves are a singular basis when they are
// parallel.
struct Tangential {
  Vec3d impulse;
  double energy_change;
};

// `inertia_first` is s12^2 / I of the first needle, `masses` the sum of the inverse masses.
Tangential tangential(const kernels::ContactGeometry& c, const Vec3d& v, double masses,
                      double inertia_first, double inertia_second, double beta) {
  // The first axis is along the longer bisector. When the needles are exchanged, each axis keeps
  // its sign or flips it together with the component along it, so no bit changes.
  const bool acute = dot(c.u_first, c.u_second) >= 0;
  const Vec3d e1 = normalised(acute ? c.u_first + c.u_second : c.u_first - c.u_second);
  const Vec3d e2 = cross(c.normal, e1);
  const double a1 = dot(c.u_first, e1), a2 = dot(c.u_first, e2);
  const double b1 = dot(c.u_second, e1), b2 = dot(c.u_second, e2);
  const double v1 = dot(v, e1), v2 = dot(v, e2);
  // Mass matrix (1/m1 + 1/m2) 1 + (s12^2/I1)(1 - u1 u1) + (s21^2/I2)(1 - u2 u2).
  const double m11 = masses + (inertia_first * (1 - a1 * a1) + inertia_second * (1 - b1 * b1));
  const double m22 = masses + (inertia_first * (1 - a2 * a2) + inertia_second * (1 - b2 * b2));
  const double m12 = -(inertia_first * (a1 * a2) + inertia_second * (b1 * b2));
  const double determinant = m11 * m22 - m12 * m12;
  const double x1 = (m22 * v1 - m12 * v2) / determinant;
  const double x2 = (m11 * v2 - m12 * v1) / determinant;
  return {(e1 * x1 + e2 * x2) * -(1 + beta), -0.5 * (1 - beta * beta) * (v1 * x1 + v2 * x2)};
}

}  // namespace

template <Surface surface>
Impact collide(const CollidingPair& pair, const Restitution& restitution) {
  const auto& [v_first, w_first, v_second, w_second, body_first, body_second, c, side, growth,
               scale] = pair;
  const double epsilon = restitution.epsilon;
  constexpr bool are_spheres = surface == Surface::sphere || surface == Surface::rough_sphere;
  constexpr bool turns = !are_spheres;
  Vec3d v = v_first - v_second;
  if constexpr (turns) {
    v += cross(w_first, c.u_first) * c.arm_first - cross(w_second, c.u_second) * c.arm_second;
  }
  constexpr bool may_grow = surface == Surface::wide || are_spheres;
  double vn = dot(v, c.normal);
  if constexpr (may_grow) vn -= growth;
  if (vn * side > 0) vn = 0;
  const double masses = body_first.inverse_mass + body_second.inverse_mass;
  double inertia_first = 0, inertia_second = 0;
  if constexpr (turns) {
    inertia_first = body_first.inverse_inertia * (c.arm_first * c.arm_first);
    inertia_second = body_second.inverse_inertia * (c.arm_second * c.arm_second);
  }
  if constexpr (surface == Surface::wide) {
    const Vec3d x_first = cross(c.u_first, c.normal), x_second = cross(c.u_second, c.normal);
    inertia_first *= dot(x_first, x_first);
    inertia_second *= dot(x_second, x_second);
  }
  const double mass = masses + (inertia_first + inertia_second);
  Impact out;
  out.normal_velocity = vn;
  out.impulse = c.normal * (-(1 + epsilon) * vn / mass);
  out.energy_change = -0.5 * (1 - epsilon * epsilon) * (vn * vn) / mass;
  if constexpr (may_grow) {
    if (growth > 0) {
      out.normal_velocity += growth;
      out.growth_work = -(1 + epsilon) * vn / mass * growth;
      out.energy_change += out.growth_work;
    }
  }
  if constexpr (surface == Surface::rough) {
    const Tangential t = tangential(c, v, masses, inertia_first, inertia_second, restitution.beta);
    out.impulse += t.impulse;
    out.energy_change += t.energy_change;
  }
  // From the centre to the contact, of spheres: less n and plus n by their radii.
  const double radius_first = scale * body_first.radius, radius_second = scale * body_second.radius;
  const double spin_first = body_first.inverse_inertia * radius_first,
               spin_second = body_second.inverse_inertia * radius_second;
  Vec3d twist;
  if constexpr (surface == Surface::rough_sphere) {
    const Vec3d slip = (v - c.normal * dot(v, c.normal)) -
                       cross(w_first * radius_first + w_second * radius_second, c.normal);
    const double of_slip = mass + (spin_first * radius_first + spin_second * radius_second);
    const double beta = restitution.beta;
    const Vec3d along = slip * (-(1 + beta) / of_slip);
    twist = cross(c.normal, along);
    out.impulse += along;
    out.energy_change -= 0.5 * (1 - beta * beta) * dot(slip, slip) / of_slip;
  }
  out.v_first = v_first + out.impulse * body_first.inverse_mass;
  out.v_second = v_second - out.impulse * body_second.inverse_mass;
  if constexpr (are_spheres) {
    out.w_first = w_first - twist * spin_first;
    out.w_second = w_second - twist * spin_second;
    return out;
  }
  out.w_first =
      w_first + cross(c.u_first, out.impulse) * (body_first.inverse_inertia * c.arm_first);
  out.w_second =
      w_second - cross(c.u_second, out.impulse) * (body_second.inverse_inertia * c.arm_second);
  return out;
}

template Impact collide<Surface::smooth>(const CollidingPair&, const Restitution&);
template Impact collide<Surface::rough>(const CollidingPair&, const Restitution&);
template Impact collide<Surface::wide>(const CollidingPair&, const Restitution&);
template Impact collide<Surface::sphere>(const CollidingPair&, const Restitution&);
template Impact collide<Surface::rough_sphere>(const CollidingPair&, const Restitution&);

}  // namespace needlework
