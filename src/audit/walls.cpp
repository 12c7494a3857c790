#include "src/audit/walls.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <limits>

#include "src/audit/there.h"

namespace needlework::audit {
namespace {

constexpr double two_pi = 2 * boost::math::constants::pi<double>();
constexpr double unit = 0x1p-53;

// The phase of a wall's motion at this time, below one turn but for its own phase, with the digits
// that a time of any age has.
double phase_at(const Wall& wall, const Instant& time) {
  const auto part = [](const Quad& turns) {
    using std::floor;
    return Quad(turns - floor(turns));
  };
  const Quad turns = part(Quad(wall.frequency) * Quad(static_cast<double>(time.epoch))) +
                     Quad(wall.frequency) * Quad(time.offset);
  return two_pi * static_cast<double>(part(turns)) + wall.phase;
}

// Time since the start, in epochs.
Quad age(const Instant& time) { return Quad(static_cast<double>(time.epoch)) + Quad(time.offset); }

// When a wall with a velocity comes to rest.
Quad halt_of(const Wall& wall) {
  return (Quad(wall.stop) - Quad(wall.place)) / Quad(wall.velocity);
}

bool is_moving(const Wall& wall, const Instant& now) {
  return wall.velocity != 0 && !(wall.stops && age(now) >= halt_of(wall));
}

// Place of the surface of a wall, but for what it shakes.
Quad place_at(const Wall& wall, const Instant& now) {
  if (is_moving(wall, now)) return Quad(wall.place) + Quad(wall.velocity) * age(now);
  return wall.velocity != 0 ? wall.stop : wall.place;
}

}  // namespace

std::vector<Wall> walls_of(const std::vector<Scene::Wall>& walls, const std::array<double, 3>& box,
                           double epoch_length, double length_unit) {
  std::vector<Wall> out;
  for (const Scene::Wall& each : walls) {
    Wall wall;
    wall.axis = each.axis == "x" ? 0 : each.axis == "y" ? 1 : 2;
    wall.epsilon = each.epsilon;
    wall.draws = each.temperature.has_value();
    if (each.motion) {
      wall.amplitude = each.motion->amplitude / length_unit;
      wall.frequency = each.motion->frequency * epoch_length;
      wall.phase = each.motion->phase;
      wall.velocity = each.motion->velocity.value_or(0) * (epoch_length / length_unit);
      wall.stops = each.motion->stop_at.has_value();
      wall.stop = each.motion->stop_at.value_or(0) / length_unit;
    }
    for (const bool high : {false, true}) {
      if (each.side == (high ? "low" : "high")) continue;
      wall.high = high;
      wall.place = high ? box[static_cast<std::size_t>(wall.axis)] : 0;
      out.push_back(wall);
    }
  }
  return out;
}

TipFlight::TipFlight(const Needle& needle, const Space& space, const Wall& wall, int tip)
    : axis_(wall.axis),
      growth_(space.growth ? static_cast<double>(space.growth->relative_rate_at(needle.record.time))
                           : 0),
      sign_(wall.sign()),
      centre_(static_cast<double>(Quad(needle.record.r[wall.axis]) -
                                  place_at(wall, needle.record.time))),
      speed_(needle.record.v[wall.axis]),
      half_fall_(space.gravity[wall.axis] / 2),
      arm_(tip * needle.body.length / 2 * space.scale_at(needle.record.time)),
      along_(needle.flight.u[wall.axis].middle),
      across_(needle.flight.side[wall.axis].middle),
      omega_(needle.flight.omega.middle),
      amplitude_(wall.amplitude),
      turn_(two_pi * wall.frequency),
      angle_(wall.amplitude > 0 ? phase_at(wall, needle.record.time) : 0),
      bend_(2 * std::abs(half_fall_) +
            std::abs(arm_) * omega_ * omega_ * std::hypot(along_, across_) +
            amplitude_ * turn_ * turn_),
      turned_(std::abs(arm_) * omega_ * std::hypot(along_, across_)) {
  // The caps of rods touch with half their diameter.
  const double radius = 0.5 * needle.body.diameter * space.scale_at(needle.record.time);
  centre_ -= sign_ * radius;
  speed_ -= sign_ * radius * growth_;
  if (!is_moving(wall, needle.record.time)) return;
  drift_ = wall.velocity;
  halt_ = wall.stops ? static_cast<double>(halt_of(wall) - age(needle.record.time))
                     : std::numeric_limits<double>::infinity();
}

TipFlight::TipFlight(const Guide& guide, double duration, const Space& space, const Wall& wall,
                     int tip)
    : TipFlight(guide.needle, space, wall, tip) {
  if (!guide.joint) return;
  joint_ = guide.joint;
  index_ = guide.index;
  centre_ -= guide.needle.record.r[wall.axis];
  const JointMotion::Most most = joint_->most(index_, 0, duration);
  bend_ = 2 * std::abs(half_fall_) + most.acceleration + std::abs(arm_) * most.turned_faster +
          amplitude_ * turn_ * turn_;
}

TipFlight::Point TipFlight::tip_at(double s) const {
  const double fall = half_fall_ * s;
  if (joint_) {
    const BodyState stance = joint_->at(index_, s);
    return {centre_ + static_cast<double>(stance.r[axis_] + arm_ * stance.u[axis_]) + fall * s,
            static_cast<double>(stance.v[axis_] + arm_ * stance.du[axis_]) + 2 * fall};
  }
  const double cosine = std::cos(omega_ * s), sine = std::sin(omega_ * s);
  const double along = along_ * cosine + across_ * sine, grown = 1 + growth_ * s;
  return {centre_ + (speed_ + fall) * s + arm_ * grown * along,
          speed_ + 2 * fall +
              arm_ * (grown * omega_ * (across_ * cosine - along_ * sine) + growth_ * along)};
}

double TipFlight::height(double s) const {
  const double shaken = amplitude_ > 0 ? amplitude_ * std::sin(phase(s)) : 0;
  const double surface = shaken + drift_ * std::min(s, halt_);
  return sign_ * (tip_at(s).place - surface);
}

double TipFlight::rate(double s) const {
  const double shaken = amplitude_ > 0 ? amplitude_ * turn_ * std::cos(phase(s)) : 0;
  const double surface = shaken + (s < halt_ ? drift_ : 0);
  return sign_ * (tip_at(s).velocity - surface);
}

// Halves intervals until bounds on the first and second derivatives show that the tip stays out.
std::optional<double> TipFlight::crossing(double from, double to, double tolerance) const {
  struct Stretch {
    double begin, end;
  };
  std::vector<Stretch> stretches{{from, to}};
  if (from < halt_ && halt_ < to) stretches = {{halt_, to}, {from, halt_}};  // a kink between
  while (!stretches.empty()) {
    const Stretch stretch = stretches.back();
    stretches.pop_back();
    const double half = 0.5 * (stretch.end - stretch.begin), middle = stretch.begin + half;
    const double h = height(middle);
    if (h < -tolerance) return middle;
    if (h - (std::abs(rate(middle)) + 0.5 * bend(to) * half) * half >= -tolerance) continue;
    if (half <= 0x1p-51 * std::max(std::abs(stretch.begin), std::abs(stretch.end))) continue;
    stretches.push_back({middle, stretch.end});
    stretches.push_back({stretch.begin, middle});
  }
  return std::nullopt;
}

double excess_over_flight(const Needle& needle, const Vector<double>& gravity, const Instant& now,
                          const StateAfterCollision& after, const Space& space) {
  Excess excess;
  add_place(excess, There(needle, gravity, now), vector(after.position), vector(after.orientation),
            space);
  return excess.most();
}

double excess_over_wall_rule(const Needle& needle, const Wall& wall, const Instant& now,
                             const Collision& hit, const Space& space) {
  const Vector<double>& gravity = space.gravity;
  const There there(needle, gravity, now);
  const double scale = space.scale_at(now), off_scale = space.growth ? space.growth->off(scale) : 0;
  const AuditedBody& body = needle.body;
  const Quad n = wall.sign(), arm = hit.arm_first;
  Excess excess;
  add_place(excess, there, vector(hit.after[0].position), vector(hit.after[0].orientation), space);
  // Of a tip, and of no other needle.
  const double half = body.length / 2 * scale;
  excess.add(Quad(std::abs(hit.arm_first) - half), (4 * unit + off_scale) * half);
  const bool alone = hit.arm_second == 0 && hit.shift == std::array<std::int32_t, 3>{};
  excess.add(alone ? 0.0 : NAN, 1);

  // V_n = (v + s w x u) . n relative to the surface, and 1/m + (L^2 / 4 I)(1 - (u . n)^2). Growth
  // brings the surfaces together as the distance of the centre from the wall grows.
  const double phase = phase_at(wall, now);
  const Quad surface = wall.amplitude * two_pi * wall.frequency * std::cos(phase) +
                       (is_moving(wall, now) ? wall.velocity : 0);
  const Quad lift = there.u[wall.axis];
  const Vector<Quad> turn = cross(there.w, there.u);
  const Quad tip = n * (there.v[wall.axis] + turn[wall.axis] * arm);
  const Quad vn = tip - n * surface;
  Quad closing = 0;
  if (space.growth) {
    const Quad distance = body.diameter / 2 * scale - n * lift * arm;
    closing = space.growth->relative_rate_at(now) * distance;
  }
  const Quad inverse_mass = body.inverse_mass<Quad>();
  const Quad inverse_inertia = body.inverse_inertia<Quad>();
  const Quad give = inverse_mass + inverse_inertia * arm * arm * (1 - lift * lift);

  // What rounding explains: directors are off by half units, which grow with the angle turned; the
  // phase of the wall likewise.
  const double speed = magnitude(norm(there.v)) + magnitude(norm(there.w)) * body.extent() +
                       magnitude(surface) + magnitude(closing) +
                       norm(gravity) * magnitude(elapsed<Quad>(needle.record.time, now).middle);
  const double shaken = wall.amplitude * two_pi * wall.frequency * 16 * unit *
                        (1 + std::abs(phase)) * (1 + two_pi * wall.frequency);
  const double grown = space.growth ? space.growth->off_rate(scale) * magnitude(closing) : 0;
  const double off =
      32 * unit * (2 + there.turned + there.flown / body.extent()) * speed + shaken + grown;
  const double push = 2 * body.mass;  // of an impulse that changes the speed of the tip by 1
  const double stiffness = 1 + body.k * scale * scale;
  excess.add(vn - Quad(hit.normal_velocity), off);
  if (wall.draws) return excess.most();

  const Quad epsilon = hit.contact_time_rule ? 1 : wall.epsilon;
  const Quad impulse = (1 + epsilon) * (closing - vn) / give;
  const Quad energy = impulse * (tip + impulse * give / 2);
  excess.add(energy - Quad(hit.energy_change), push * stiffness * off * (speed + off));
  for (int axis = 0; axis < 3; ++axis) {
    const Quad along = axis == wall.axis ? Quad(impulse * n) : Quad(0);
    excess.add(along - Quad(hit.impulse[axis]), push * off);
    excess.add(there.v[axis] + along * inverse_mass - Quad(hit.after[0].velocity[axis]), 4 * off);
  }
  Vector<Quad> kick{{Quad(0), Quad(0), Quad(0)}};
  kick[wall.axis] = impulse * n;
  const Vector<Quad> spun = there.w + cross(there.u, kick) * Quad(inverse_inertia * arm);
  for (int axis = 0; axis < 3; ++axis) {
    excess.add(spun[axis] - Quad(hit.after[0].angular_velocity[axis]),
               4 * stiffness * off / body.extent());
  }
  return excess.most();
}

}  // namespace needlework::audit
