#include "src/audit/rule.h"

#include <algorithm>
#include <cmath>

#include "src/audit/excess.h"

namespace needlework::audit {
namespace {

using Number = Ball<Quad>;
using Vector3 = Vector<Quad>;

Vector3 middle(const Vector<Number>& a) { return {{a[0].middle, a[1].middle, a[2].middle}}; }

/// The solution of M x = b for a well-conditioned M, given by its columns.
Vector3 solve(const std::array<Vector3, 3>& m, const Vector3& b) {
  const Quad determinant = dot(m[0], cross(m[1], m[2]));
  return Vector3{
             {dot(b, cross(m[1], m[2])), dot(m[0], cross(b, m[2])), dot(m[0], cross(m[1], b))}} *
         Quad(1 / determinant);
}

/// The largest difference of components.
double difference(const Vector3& a, const std::array<double, 3>& b) {
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double off = magnitude(Quad(a[axis] - b[axis]));
    most = off <= most ? most : off;  // keeps NaN
    if (std::isnan(off)) return off;
  }
  return most;
}

/// A needle at the moment of the collision.
struct Partner {
  Vector3 r, u, v, w;
  double flown;                           ///< distance since its record
  double fastest;                         ///< bound on its speed since then
  double age_in_lengths, age_in_radians;  ///< the same in lengths, and angle turned

  Partner(const Needle& needle, const Instant& now, const Vector<double>& gravity) {
    const Flight<Number> flight(needle.record);
    const Number age = elapsed<Quad>(needle.record.time, now);
    const Pose<Number> pose = flight.at(age);
    r = middle(pose.r);
    u = middle(pose.u);
    v = middle(flight.v);
    w = middle(cross(pose.u, pose.du));
    for (int axis = 0; axis < 3; ++axis) {
      const Quad gained = Quad(gravity[axis]) * age.middle;
      v[axis] += gained;
      r[axis] += gained * age.middle / 2;
    }
    fastest = magnitude(norm(middle(flight.v))) + norm(gravity) * magnitude(age.middle);
    flown = magnitude(Quad(norm(v) * age.middle)) +
            norm(gravity) * magnitude(Quad(age.middle * age.middle));
    age_in_lengths = flown / needle.body.length;
    age_in_radians = magnitude(Quad(flight.omega.middle * age.middle));
  }
  bool may_be_renewed() const { return std::max(age_in_lengths, age_in_radians) > longest_record; }
};

}  // namespace

double excess_over_rule(const Needle& first, const Needle& second, const Instant& now,
                        const Collision& collision, const Rule& rule, const Space& space) {
  const std::array<Partner, 2> needles = {Partner(first, now, space.gravity),
                                          Partner(second, now, space.gravity)};
  const auto& [a, b] = needles;
  // Records of needles that fall are renewed sooner.
  const bool renewed = a.may_be_renewed() || b.may_be_renewed() || norm(space.gravity) > 0;
  bool right_image = true;
  Vector3 r = a.r - b.r;
  for (int axis = 0; axis < 3; ++axis) {
    const Quad boxes = space.boxes_along<Quad>(axis, r[axis]);
    r[axis] -= Quad(space.box[axis]) * boxes;
    right_image = right_image && boxes == collision.shift[axis];
  }
  const Vector3 x = cross(a.u, b.u);
  const Quad xx = dot(x, x), sine = norm(x);
  const Vector3 n = x * Quad(1 / sine);
  const Quad s12 = dot(cross(b.u, r), x) / xx, s21 = dot(cross(a.u, r), x) / xx;
  const Vector3 velocity = a.v - b.v + cross(a.w, a.u) * s12 - cross(b.w, b.u) * s21;
  const Quad vn = dot(velocity, n);
  const Quad epsilon = collision.contact_time_rule ? 1 : rule.epsilon;
  const Quad beta = collision.contact_time_rule ? -1 : rule.beta;

  // M = (1/m1 + 1/m2) 1 + (s12^2/I1)(1 - u1 u1) + (s21^2/I2)(1 - u2 u2), and the right-hand side.
  const std::array<Body, 2> bodies = {first.body, second.body};
  std::array<Quad, 2> inverse_mass, inverse_inertia;
  for (int i = 0; i < 2; ++i) {
    const Body& body = bodies[i];
    inverse_mass[i] = Quad(1) / Quad(body.mass);
    // I = m L^2 / (2 k).
    inverse_inertia[i] = 2 * Quad(body.k) * inverse_mass[i] / (Quad(body.length) * body.length);
  }
  const Quad masses = inverse_mass[0] + inverse_mass[1];
  const Quad c1 = inverse_inertia[0] * s12 * s12, c2 = inverse_inertia[1] * s21 * s21;
  std::array<Vector3, 3> mass;
  for (int i = 0; i < 3; ++i) {
    mass[i] = a.u * Quad(-c1 * a.u[i]) - b.u * Quad(c2 * b.u[i]);
    mass[i][i] += masses + c1 + c2;
  }
  const Vector3 tangential = velocity - n * vn;
  const Vector3 impulse = solve(mass, n * Quad(-(1 + epsilon) * vn) - tangential * Quad(1 + beta));
  const Vector3 turn_first = cross(a.u, impulse) * Quad(inverse_inertia[0] * s12);
  const Vector3 turn_second = cross(b.u, impulse) * Quad(inverse_inertia[1] * s21);

  // Errors that rounding explains: half units of centres and directors, which grow with the
  // distance flown. The arms and the normal lose digits near parallel directors.
  constexpr double unit = 0x1p-53;
  const double flown = a.flown + b.flown;
  const double turned = a.age_in_radians + b.age_in_radians;
  const double flexible = 8 * unit * (2 + flown + turned) / magnitude(sine);
  const double speed = a.fastest + b.fastest +
                       magnitude(Quad(norm(a.w) * bodies[0].length + norm(b.w) * bodies[1].length));
  // Twice the ratio of the largest and the smallest M, which has its tips.
  const auto at_tip = [&](int i) { return bodies[i].k / 2 * magnitude(inverse_mass[i]); };
  const double least_mass = magnitude(masses);
  const double stiffness = 2 * (least_mass + at_tip(0) + at_tip(1)) / least_mass;
  // Of an impulse that changes the relative velocity by 1.
  const double push = 2 / least_mass;
  const double geometry = flexible + (renewed ? space.rounding() / magnitude(sine) : 0);
  // Of speeds at the contact and of M, which depend on arms in lengths.
  const double share = geometry / std::min(bodies[0].length, bodies[1].length);
  Excess excess;
  // Renewals wrap centres, and the shift changes with them.
  excess.add(right_image || renewed ? 0.0 : NAN, 1);
  excess.add(magnitude(Quad(s12 - collision.arm_first)), geometry);
  excess.add(magnitude(Quad(s21 - collision.arm_second)), geometry);
  excess.add(magnitude(Quad(sine - collision.sin_angle)), geometry);
  excess.add(magnitude(Quad(vn - collision.normal_velocity)), stiffness * share * speed);
  excess.add(difference(impulse, collision.impulse), push * stiffness * share * speed);
  // The energy change is the impulse times the mean of the relative velocities before and after
  // it, which differ by M dp.
  const Vector3 kick = mass[0] * impulse[0] + mass[1] * impulse[1] + mass[2] * impulse[2];
  const Quad energy = dot(impulse, velocity + kick * Quad(0.5));
  excess.add(magnitude(Quad(energy - collision.energy_change)),
             push * stiffness * share * speed * speed);
  const std::array<Vector3, 2> v_after = {a.v + impulse * inverse_mass[0],
                                          b.v - impulse * inverse_mass[1]};
  const std::array<Vector3, 2> w_after = {a.w + turn_first, b.w - turn_second};
  for (int i = 0; i < 2; ++i) {
    const Partner& before = needles[i];
    const StateAfterCollision& after = collision.after[i];
    Vector3 moved = before.r - to<Quad>(vector(after.position));
    for (int axis = 0; axis < 3; ++axis) {
      moved[axis] -= Quad(space.box[axis]) * space.boxes_along<Quad>(axis, moved[axis]);
    }
    excess.add(difference(moved, {}), space.rounding() + 8 * unit * before.flown);
    excess.add(difference(before.u, after.orientation), 8 * unit * (2 + before.age_in_radians));
    // The velocity itself is rounded, too, however heavy the needle is.
    const double kicked = std::max(1.0, push * magnitude(inverse_mass[i]));
    excess.add(difference(v_after[i], after.velocity), kicked * stiffness * share * speed);
    excess.add(difference(w_after[i], after.angular_velocity),
               (2 + bodies[i].k) * kicked * stiffness * share * speed / bodies[i].length);
  }
  return excess.most();
}

}  // namespace needlework::audit
