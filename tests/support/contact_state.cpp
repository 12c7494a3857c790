#include "tests/support/contact_state.h"

namespace needlework::test {
namespace {

/// The part of a normal to the unit vector u.
Vec<Real> normal_part(const Vec<Real>& a, const Vec<Real>& u) { return a - Real(dot(a, u)) * u; }

Vec<Real> unit(const Vec<Real>& a) { return Real(1 / norm(a)) * a; }

Vec<Real> wide(const Vec<double>& a) { return convert<Real>(a); }

}  // namespace

NeedleState flown(const NeedleState& needle, const Real& time) {
  NeedleState moved = needle;
  moved.position = needle.position + time * needle.velocity;
  const Real spin = norm(needle.angular_velocity);
  if (spin > 0) {
    const Vec<Real> side = Real(1 / spin) * cross(needle.angular_velocity, needle.orientation);
    moved.orientation =
        Real(cos(Real(spin * time))) * needle.orientation + Real(sin(Real(spin * time))) * side;
  }
  return moved;
}

NeedleState read(const FreeNeedle& needle) {
  NeedleState state{wide(needle.position), unit(wide(needle.orientation)), wide(needle.velocity),
                    wide(needle.angular_velocity)};
  state.angular_velocity = normal_part(state.angular_velocity, state.orientation);
  return state;
}

FreeNeedle rounded(const NeedleState& needle) {
  return {convert<double>(needle.position), convert<double>(needle.orientation),
          convert<double>(needle.velocity), convert<double>(needle.angular_velocity)};
}

PairState draw_contact(Random& random, const ContactRecipe& recipe) {
  PairState pair;
  NeedleState &a = pair.first, &b = pair.second;
  a.orientation = unit(wide(random.direction()));
  if (recipe.angle_sine > 0) {
    const Vec<Real> across = unit(normal_part(wide(random.direction()), a.orientation));
    const Real sine = recipe.angle_sine, cosine = sqrt(Real(1 - sine * sine));
    b.orientation = Real(random.coin() ? cosine : -cosine) * a.orientation + sine * across;
  } else {
    b.orientation = unit(wide(random.direction()));
  }
  // The contact point lies anywhere in a box around the origin.
  const Vec<Real> point =
      wide({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  a.position = point - Real(recipe.arms[0]) * a.orientation;
  b.position = point - Real(recipe.arms[1]) * b.orientation;
  a.velocity = wide(random.normal_vector(recipe.speed));
  b.velocity = wide(random.normal_vector(recipe.speed));
  a.angular_velocity = normal_part(wide(random.normal_vector(recipe.spin[0])), a.orientation);
  b.angular_velocity = normal_part(wide(random.normal_vector(recipe.spin[1])), b.orientation);
  return pair;
}

Slopes slopes(const PairState& pair) {
  const NeedleState &a = pair.first, &b = pair.second;
  const Vec<Real> r = a.position - b.position, v = a.velocity - b.velocity;
  const Vec<Real> da = cross(a.angular_velocity, a.orientation);
  const Vec<Real> db = cross(b.angular_velocity, b.orientation);
  const Vec<Real> x = cross(a.orientation, b.orientation);
  const Vec<Real> dx = cross(da, b.orientation) + cross(a.orientation, db);
  const Real turn =
      dot(a.angular_velocity, a.angular_velocity) + dot(b.angular_velocity, b.angular_velocity);
  const Vec<Real> ddx = Real(2) * cross(da, db) - turn * x;
  return {dot(r, x), dot(v, x) + dot(r, dx), 2 * dot(v, dx) + dot(r, ddx)};
}

Vec<Real> contact_normal(const PairState& pair) {
  return unit(cross(pair.first.orientation, pair.second.orientation));
}

void push(PairState& pair, const Real& change) {
  const Vec<Real> half = Real(change / 2) * contact_normal(pair);
  pair.first.velocity = pair.first.velocity + half;
  pair.second.velocity = pair.second.velocity - half;
}

NeedlePair before_contact(const PairState& state, double time, double horizon) {
  NeedlePair pair;
  pair.first = rounded(flown(state.first, -Real(time)));
  pair.second = rounded(flown(state.second, -Real(time)));
  pair.horizon = horizon;
  if (time > 0) pair.contact_time = time;
  return pair;
}

}  // namespace needlework::test
