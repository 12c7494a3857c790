#include "src/audit/rule.h"

#include <algorithm>
#include <cmath>

namespace needlework::audit {
namespace {

using Number = Ball<Quad>;
using Vector3 = Vector<Quad>;

Vector3 middle(const Vector<Number>& a) { return {{a[0].middle, a[1].middle, a[2].middle}}; }
Quad nearest(const Quad& a) {
  using std::floor;
  return floor(a + Quad(0.5));
}

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
  double age_in_lengths, age_in_radians;  ///< distance flown and angle turned since its record

  Partner(const Needle& needle, const Instant& now) {
    const Flight<Number> flight(needle.record);
    const Number age = elapsed<Quad>(needle.record.time, now);
    const Pose<Number> pose = flight.at(age);
    r = middle(pose.r);
    u = middle(pose.u);
    v = middle(flight.v);
    w = middle(cross(pose.u, pose.du));
    age_in_lengths = magnitude(Quad(norm(v) * age.middle));
    age_in_radians = magnitude(Quad(flight.omega.middle * age.middle));
  }
  bool may_be_renewed() const { return std::max(age_in_lengths, age_in_radians) > longest_record; }
};

class Excess {
 public:
  void add(double deviation, double explained) {
    const double excess = deviation == 0 ? 0 : deviation / explained;
    most_ = excess <= most_ ? most_ : std::isnan(excess) ? HUGE_VAL : excess;
  }
  double most() const { return most_; }

 private:
  double most_ = 0;
};

}  // namespace

double excess_over_rule(const Needle& first, const Needle& second, const Instant& now,
                        const Collision& collision, const Rule& rule, const Space& space) {
  const std::array<Partner, 2> needles = {Partner(first, now), Partner(second, now)};
  const auto& [a, b] = needles;
  const bool renewed = a.may_be_renewed() || b.may_be_renewed();
  bool right_image = true;
  Vector3 r = a.r - b.r;
  for (int axis = 0; axis < 3; ++axis) {
    const Quad boxes = nearest(Quad(r[axis] / Quad(space.box[axis])));
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

  // M = (2/m) 1 + (s12^2/I)(1 - u1 u1) + (s21^2/I)(1 - u2 u2), and the right-hand side.
  const Quad inverse_inertia = 2 * Quad(rule.k);
  const Quad c1 = inverse_inertia * s12 * s12, c2 = inverse_inertia * s21 * s21;
  std::array<Vector3, 3> mass;
  for (int i = 0; i < 3; ++i) {
    mass[i] = a.u * Quad(-c1 * a.u[i]) - b.u * Quad(c2 * b.u[i]);
    mass[i][i] += 2 + c1 + c2;
  }
  const Vector3 tangential = velocity - n * vn;
  const Vector3 impulse = solve(mass, n * Quad(-(1 + epsilon) * vn) - tangential * Quad(1 + beta));
  const Vector3 turn_first = cross(a.u, impulse) * Quad(inverse_inertia * s12);
  const Vector3 turn_second = cross(b.u, impulse) * Quad(inverse_inertia * s21);

  // Errors that rounding explains: half units of centres and directors, which grow with the
  // distance flown. The arms and the normal lose digits near parallel directors.
  constexpr double unit = 0x1p-53;
  const double flown = a.age_in_lengths + b.age_in_lengths;
  const double turned = a.age_in_radians + b.age_in_radians;
  const double flexible = 8 * unit * (2 + flown + turned) / magnitude(sine);
  const double speed = magnitude(Quad(norm(a.v) + norm(b.v) + norm(a.w) + norm(b.w)));
  const double stiffness = 2 + rule.k;
  const double geometry = flexible + (renewed ? space.rounding() / magnitude(sine) : 0);
  Excess excess;
  // Renewals wrap centres, and the shift changes with them.
  excess.add(right_image || renewed ? 0 : NAN, 1);
  excess.add(magnitude(Quad(s12 - collision.arm_first)), geometry);
  excess.add(magnitude(Quad(s21 - collision.arm_second)), geometry);
  excess.add(magnitude(Quad(sine - collision.sin_angle)), geometry);
  excess.add(magnitude(Quad(vn - collision.normal_velocity)), stiffness * geometry * speed);
  excess.add(difference(impulse, collision.impulse), stiffness * geometry * speed);
  // The energy change is the impulse times the mean of the relative velocities before and after
  // it, which differ by M dp.
  const Vector3 kick = mass[0] * impulse[0] + mass[1] * impulse[1] + mass[2] * impulse[2];
  const Quad energy = dot(impulse, velocity + kick * Quad(0.5));
  excess.add(magnitude(Quad(energy - collision.energy_change)),
             stiffness * geometry * speed * speed);
  const std::array<Vector3, 2> v_after = {a.v + impulse, b.v - impulse};
  const std::array<Vector3, 2> w_after = {a.w + turn_first, b.w - turn_second};
  for (int i = 0; i < 2; ++i) {
    const Partner& before = needles[i];
    const StateAfterCollision& after = collision.after[i];
    Vector3 moved = before.r - to<Quad>(vector(after.position));
    for (int axis = 0; axis < 3; ++axis) {
      moved[axis] -= Quad(space.box[axis]) * nearest(Quad(moved[axis] / Quad(space.box[axis])));
    }
    excess.add(difference(moved, {}), space.rounding() + 8 * unit * before.age_in_lengths);
    excess.add(difference(before.u, after.orientation), 8 * unit * (2 + before.age_in_radians));
    excess.add(difference(v_after[i], after.velocity), stiffness * geometry * speed);
    excess.add(difference(w_after[i], after.angular_velocity),
               stiffness * stiffness * geometry * speed);
  }
  return excess.most();
}

}  // namespace needlework::audit
