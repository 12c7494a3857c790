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
  double turned;                          ///< as many radians make directors as uncertain
  bool worn;                              ///< in contact, of which each step makes a new record

  Partner(const Needle& needle, const Instant& now, const Vector<double>& gravity) {
    const auto flight = needle.flight_as<Number>();
    const Number age = elapsed<Quad>(needle.record.time, now);
    const Pose<Number> pose = flight.at(age);
    r = middle(pose.r);
    u = middle(pose.u);
    v = middle(flight.v);
    w = middle(needle.spin(pose));
    for (int axis = 0; axis < 3; ++axis) {
      const Quad gained = Quad(gravity[axis]) * age.middle;
      v[axis] += gained;
      r[axis] += gained * age.middle / 2;
    }
    fastest = magnitude(norm(middle(flight.v))) + norm(gravity) * magnitude(age.middle);
    flown = magnitude(Quad(norm(v) * age.middle)) +
            norm(gravity) * magnitude(Quad(age.middle * age.middle));
    age_in_lengths = flown / needle.body.extent();
    age_in_radians = magnitude(Quad(flight.omega.middle * age.middle));
    turned = age_in_radians + needle.worn;
    worn = needle.worn > 0;
    flown += needle.worn * needle.body.extent();
  }
  bool may_be_renewed() const {
    return worn || std::max(age_in_lengths, age_in_radians) > longest_record;
  }
};

/// Where two needles touch. The arms of needles, and all normals, are off by what rounding does.
struct Contact {
  Quad s12, s21;
  Vector3 n;
  double geometry;  ///< what rounding does to lengths [L]
  double share;     ///< the same of speeds at the contact and of M, which depend on arms in lengths
};

/// Errors that rounding explains are half units of centres and directors, which grow with the
/// distance flown. The arms and the normal lose digits near parallel directors.
Contact contact_of_needles(const Partner& a, const Partner& b, const Vector3& r, double flexible,
                           double renewed, double shortest) {
  const Vector3 x = cross(a.u, b.u);
  const Quad xx = dot(x, x), sine = norm(x);
  Contact out{dot(cross(b.u, r), x) / xx, dot(cross(a.u, r), x) / xx, x * Quad(1 / sine),
              (flexible + renewed) / magnitude(sine), 0};
  out.share = out.geometry / shortest;
  return out;
}

/// From a body's centre to the contact: so far along this direction.
struct Lever {
  Vector3 along;
  Quad arm;
};

/// Of nearly parallel rods, rounding decides which points are nearest; those of the report are,
/// where the distance grows from them in both directions, or on from the ends. All else follows
/// from them. Their sizes may be off by this share.
Contact contact_of_rods(const Partner& a, const Partner& b, const Vector3& r,
                        const std::array<AuditedBody, 2>& bodies, double off_size,
                        const Collision& collision, double geometry, Excess& excess) {
  const std::array arms = {collision.arm_first, collision.arm_second};
  const Vector3 p = r + a.u * Quad(arms[0]) - b.u * Quad(arms[1]);
  const std::array rates = {magnitude(dot(p, a.u)), magnitude(dot(p, b.u))};
  const std::array outwards = {dot(p, a.u) * arms[0], -dot(p, b.u) * arms[1]};
  for (std::size_t i = 0; i < 2; ++i) {
    const double half = 0.5 * bodies[i].length, arm = std::abs(arms[i]);
    const double off = 0x1p-51 + off_size;
    excess.add(std::max(0.0, arm - half), half * off);
    const bool at_end = arm >= half * (1 - off);
    excess.add(half == 0 || (at_end && outwards[i] < 0) ? 0.0 : rates[i], geometry);
  }
  const double distance = 0.5 * (bodies[0].diameter + bodies[1].diameter);
  return {arms[0], arms[1], p * Quad(1 / norm(p)), geometry, geometry / distance};
}

}  // namespace

double excess_over_rule(const Needle& first, const Needle& second, const Instant& now,
                        const Collision& collision, const Rule& rule, const Space& of_gas) {
  const Space space = of_gas.around(vector(collision.after[0].position))
                          .around(vector(collision.after[1].position));
  const std::array<Partner, 2> needles = {Partner(first, now, space.gravity),
                                          Partner(second, now, space.gravity)};
  const auto& [a, b] = needles;
  // Records of needles that fall are renewed sooner.
  const bool renewed = a.may_be_renewed() || b.may_be_renewed() || space.rounds();
  bool right_image = true;
  Vector3 r = a.r - b.r, past{};
  const Rows::Slide slide = space.rows ? space.rows->at(now) : Rows::Slide{};
  std::uint32_t slid = 0;  // whole boxes of the image's row
  for (const int axis : {1, 0, 2}) {
    const Quad boxes = space.boxes_along<Quad>(axis, r[axis]);
    r[axis] -= Quad(space.box[axis]) * boxes;
    const auto whole =
        static_cast<std::int32_t>(boxes) - (axis == 0 ? static_cast<std::int32_t>(slid) : 0);
    right_image = right_image && whole == collision.shift[axis];
    if (axis == 1 && space.rows) {
      r[0] -= boxes * slide.offset;
      past[0] = boxes * space.rows->velocity();
      slid = static_cast<std::uint32_t>(static_cast<std::int32_t>(boxes)) * slide.boxes;
    }
  }
  const double scale = space.scale_at(now);
  const double off_size = space.growth ? space.growth->off(scale) : 0;
  const std::array<AuditedBody, 2> bodies = {first.body.grown(scale), second.body.grown(scale)};
  const bool wide = first.body.diameter + second.body.diameter > 0;
  constexpr double unit = 0x1p-53;
  const double flexible = 8 * unit * (2 + a.flown + b.flown + (a.turned + b.turned));
  const double off_by_renewal = renewed ? space.rounding() : 0;
  Excess excess;
  const Contact contact = wide ? contact_of_rods(a, b, r, bodies, off_size, collision,
                                                 flexible + off_by_renewal, excess)
                               : contact_of_needles(a, b, r, flexible, off_by_renewal,
                                                    std::min(bodies[0].length, bodies[1].length));
  const auto& [s12, s21, n, geometry, share] = contact;
  const Quad sine = norm(cross(a.u, b.u));
  const bool spheres = wide && !bodies[0].has_axis() && !bodies[1].has_axis();
  const bool smooth = wide && !(spheres && rule.beta != -1);
  std::array<Lever, 2> levers = {Lever{a.u, s12}, Lever{b.u, s21}};
  if (spheres) {
    const Quad half = 0.5;
    levers = {Lever{n, -half * bodies[0].diameter}, Lever{n, half * bodies[1].diameter}};
  }
  const auto& [first_lever, second_lever] = levers;
  const Vector3 velocity = a.v - b.v - past + cross(a.w, first_lever.along) * first_lever.arm -
                           cross(b.w, second_lever.along) * second_lever.arm;
  // How fast growth brings the surfaces together: by what the distance of the centres along the
  // normal, at contact, grows.
  Quad closing = 0;
  if (space.growth) {
    const Quad distance = (Quad(bodies[0].diameter) + bodies[1].diameter) / 2;
    closing = space.growth->relative_rate_at(now) * (distance - dot(a.u * s12 - b.u * s21, n));
  }
  // Of rods, the engine takes a velocity that rounding makes part them as 0.
  const Quad approach = dot(velocity, n) - closing;
  const Quad vn = (wide && approach > 0 ? Quad(0) : approach) + closing;
  const Quad epsilon = collision.contact_time_rule ? 1 : rule.epsilon;
  // The roughness of spheres stays within the contact time.
  const Quad beta = collision.contact_time_rule && !spheres ? -1 : rule.beta;

  // M = (1/m1 + 1/m2) 1 + (s12^2/I1)(1 - u1 u1) + (s21^2/I2)(1 - u2 u2), and the right-hand side.
  // Of spheres, n and their radii are in the place of directors and arms.
  std::array<Quad, 2> inverse_mass, inverse_inertia;
  for (int i = 0; i < 2; ++i) {
    inverse_mass[i] = bodies[i].inverse_mass<Quad>();
    inverse_inertia[i] = bodies[i].inverse_inertia<Quad>();
  }
  const Quad masses = inverse_mass[0] + inverse_mass[1];
  const Quad c1 = inverse_inertia[0] * first_lever.arm * first_lever.arm,
             c2 = inverse_inertia[1] * second_lever.arm * second_lever.arm;
  std::array<Vector3, 3> mass;
  for (int i = 0; i < 3; ++i) {
    mass[i] = first_lever.along * Quad(-c1 * first_lever.along[i]) -
              second_lever.along * Quad(c2 * second_lever.along[i]);
    mass[i][i] += masses + c1 + c2;
  }
  const Vector3 tangential = velocity - n * vn;
  // The impulse of smooth rods is along the normal, which M n is not.
  const auto mass_times = [&](const Vector3& p) {
    return mass[0] * p[0] + mass[1] * p[1] + mass[2] * p[2];
  };
  const Vector3 impulse =
      smooth ? n * Quad((1 + epsilon) * (closing - vn) / dot(n, mass_times(n)))
             : solve(mass, n * Quad((1 + epsilon) * (closing - vn)) - tangential * Quad(1 + beta));
  const Vector3 turn_first =
      cross(first_lever.along, impulse) * Quad(inverse_inertia[0] * first_lever.arm);
  const Vector3 turn_second =
      cross(second_lever.along, impulse) * Quad(inverse_inertia[1] * second_lever.arm);

  const auto span = [](const AuditedBody& body) {
    return body.has_axis() ? body.length : body.diameter;
  };
  const double speed = a.fastest + b.fastest +
                       magnitude(Quad(norm(a.w) * span(bodies[0]) + norm(b.w) * span(bodies[1]))) +
                       magnitude(closing);
  const bool hardly_parts = magnitude(Quad(epsilon * vn)) < rule.parting * speed;
  const double grown = space.growth ? space.growth->off_rate(scale) * magnitude(closing) : 0;
  const double off = share * speed + grown,
               off_after = off + (hardly_parts ? 4 * rule.parting : 0) * speed;
  // Twice the ratio of the largest and the smallest M, which has its tips.
  const auto at_tip = [&](int i) {
    const double shape = bodies[i].has_axis() ? bodies[i].k / 2
                         : bodies[i].q > 0    ? 1 / bodies[i].q
                                              : 0;
    return shape * magnitude(inverse_mass[i]);
  };
  const double least_mass = magnitude(masses);
  const double stiffness = 2 * (least_mass + at_tip(0) + at_tip(1)) / least_mass;
  // Of an impulse that changes the relative velocity by 1.
  const double push = 2 / least_mass;
  // Renewals wrap centres, and the shift changes with them.
  excess.add(right_image || renewed ? 0.0 : NAN, 1);
  excess.add(magnitude(Quad(s12 - collision.arm_first)), geometry);
  excess.add(magnitude(Quad(s21 - collision.arm_second)), geometry);
  excess.add(magnitude(Quad(sine - collision.sin_angle)), geometry);
  excess.add(magnitude(Quad(vn - collision.normal_velocity)), stiffness * off);
  excess.add(difference(impulse, collision.impulse), push * stiffness * off);
  // The energy change is the impulse times the mean of the relative velocities before and after
  // it, which differ by M dp.
  const Vector3 kick = mass_times(impulse);
  const Quad energy = dot(impulse, velocity + kick * Quad(0.5));
  excess.add(magnitude(Quad(energy - collision.energy_change)), push * stiffness * off * speed);
  const std::array<Vector3, 2> v_after = {a.v + impulse * inverse_mass[0],
                                          b.v - impulse * inverse_mass[1]};
  const std::array<Vector3, 2> w_after = {a.w + turn_first, b.w - turn_second};
  for (int i = 0; i < 2; ++i) {
    const Partner& before = needles[i];
    const StateAfterCollision& after = collision.after[i];
    Vector3 moved = before.r - to<Quad>(vector(after.position)), wrapped{};
    for (const int axis : {1, 0, 2}) {
      const Quad boxes = space.boxes_along<Quad>(axis, moved[axis]);
      moved[axis] -= Quad(space.box[axis]) * boxes;
      if (axis == 1 && space.rows) {
        moved[0] -= boxes * slide.offset;
        wrapped[0] = boxes * space.rows->velocity();
      }
    }
    excess.add(difference(moved, {}), space.rounding() + 8 * unit * before.flown);
    excess.add(difference(before.u, after.orientation), 8 * unit * (2 + before.turned));
    // The velocity itself is rounded, too, however heavy the needle is.
    const double kicked = std::max(1.0, push * magnitude(inverse_mass[i]));
    excess.add(difference(v_after[i] - wrapped, after.velocity), kicked * stiffness * off_after);
    const AuditedBody& body = bodies[i];
    const double turning = body.has_axis() ? body.k / body.length
                           : body.q > 0    ? 2 / (body.q * body.diameter)
                                           : 0;
    excess.add(difference(w_after[i], after.angular_velocity),
               (2 / body.extent() + turning) * kicked * stiffness * off_after);
  }
  return excess.most();
}

}  // namespace needlework::audit
