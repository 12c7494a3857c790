#include "src/effects/walls/walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "kernels/trajectory_wall.h"
#include "src/physics/director.h"
#include "src/physics/vectors.h"
#include "src/random/needle_random.h"

namespace needlework {
namespace {

// Serial numbers of records begin above the bits of twice six walls.
constexpr unsigned bits_of_tips = 12;

void set_component(Vec3d& vector, int axis, double value) {
  (axis == 0 ? vector.x : axis == 1 ? vector.y : vector.z) = value;
}

double sign_of(int tip) { return tip == 0 ? 1 : -1; }

// Of a tip along the normal of a wall: velocity per impulse. `share` is the director's component.
double mobility_of(const Body& body, double arm, double share) {
  if (!body.has_axis()) return 1 / body.mass;
  return 1 / body.mass + arm * arm / body.inertia * (1 - share * share);
}

// By how much an impulse on a tip along the normal turns a needle.
Vec3d turn_by(const Body& body, const Vec3d& director, const Vec3d& normal, double arm,
              double impulse) {
  if (!body.has_axis()) return {};
  return cross(director, normal) * (arm * impulse / body.inertia);
}

}  // namespace

Walls::Walls(Gas& gas, std::vector<Wall> walls, std::uint64_t seed, ContactTimeOfWalls contact_time)
    : walls_(std::move(walls)),
      seed_(seed),
      contact_time_(contact_time),
      touching_(gas.columns.add<std::uint64_t>("tips at walls", ~std::uint64_t{0})) {
  for (const Species& each : gas.composition.species()) {
    if (!each.fixed) heaviest_ = std::max(heaviest_, each.mass);
  }
  const auto is_thermal = [](const Wall& wall) { return wall.temperature > 0; };
  if (std::ranges::any_of(walls_, is_thermal)) {
    draws_ = &gas.columns.add<std::uint64_t>("draws at walls", 0);
  }
}

std::vector<double> Walls::parameters() const {
  std::vector<double> out;
  for (const Wall& wall : walls_) {
    const kernels::WallPlane& plane = wall.plane;
    out.insert(out.end(),
               {static_cast<double>(plane.axis), static_cast<double>(plane.normal), plane.amplitude,
                plane.frequency, wall.turns, wall.epsilon, wall.temperature});
    if (wall.edge.moves()) {
      const double halt = to_double(wall.edge.halt_time());
      out.insert(out.end(), {wall.edge.velocity(), wall.edge.stop(), halt});
    }
    if (!(wall.sliding == Vec3d{}))
      out.insert(out.end(), {wall.sliding.x, wall.sliding.y, wall.sliding.z});
  }
  return out;
}

// That of a turn of a wall, or of its way of one length, which may set needles in motion that are
// at rest.
double Walls::usual_time() const {
  double fastest = 0;
  for (const Wall& wall : walls_) {
    if (wall.plane.amplitude > 0) fastest = std::max(fastest, wall.plane.frequency);
    fastest = std::max(fastest, std::abs(wall.edge.velocity()));
  }
  return 1 / fastest;
}

// A needle leaves a wall in motion with about twice its speed.
double Walls::usual_temperature() const {
  double out = 0;
  for (const Wall& wall : walls_) {
    const double speed =
        std::max(2 * std::numbers::pi * wall.plane.frequency * wall.plane.amplitude,
                 std::abs(wall.edge.velocity()));
    out = std::max({out, wall.temperature, heaviest_ * (4 * speed * speed),
                    heaviest_ * dot(wall.sliding, wall.sliding)});
  }
  return out;
}

// In turns, without the loss of digits that f t has late in a run.
DoubleDouble Walls::turns_at(const Clock& clock, const Wall& wall, Time time) const {
  if (!(wall.plane.amplitude > 0)) return {};
  return clock.turns(time, wall.plane.frequency) + DoubleDouble(wall.turns);
}

// The wall from this time on.
kernels::WallPlane Walls::plane_at(const Clock& clock, const Wall& wall, Time time) const {
  kernels::WallPlane out = wall.plane;
  if (!wall.edge.moves()) return out;
  const DoubleDouble since_start = clock.exact_difference(time, {});
  out.place = wall.edge.place(since_start);
  if (wall.edge.is_at_rest(since_start)) return out;
  out.velocity = wall.edge.velocity();
  // Of an infinite time the difference would be no number.
  const DoubleDouble& halt = wall.edge.halt_time();
  if (std::isfinite(halt.hi)) out.halt = to_double(halt - since_start);
  out.halt_place = wall.edge.stop();
  return out;
}

unsigned Walls::touching(const Record& record, Needle i, std::size_t wall) const {
  const std::uint64_t tips = touching_[i];
  if (tips >> bits_of_tips != record.serial) return 0;
  return static_cast<unsigned>(tips >> (2 * wall)) & 3;
}

SourceEvent Walls::next(const Gas& gas, Needle i, Time now, Time until) const {
  const Record& record = gas.records[i];
  SourceEvent out;
  if (gas.is_fixed(i)) return out;
  Time latest = until;
  std::optional<NeedleTrajectory> trajectory;
  if (gas.slides && record.is_sliding()) {
    const Id id = gas.ids[i];
    trajectory.emplace(gas, id, record, gas.slides->of(id, record), 0);
  }
  for (std::size_t n = 0; n < walls_.size(); ++n) {
    const Wall& wall = walls_[n];
    const Body body = gas.body(i);
    const double scale = gas.scale_at(record.time),
                 growth = gas.growth ? gas.growth->relative_rate(scale) : 0,
                 radius = scale * body.radius;
    // The caps of rods touch where the ends of their axes are half a diameter away.
    const kernels::WallPlane plane =
        plane_at(gas.clock, wall, record.time).for_radius(radius, growth * radius);
    const kernels::WallApproach approach{.flight = &record.flight,
                                         .gravity = component(gas.gravity, wall.plane.axis),
                                         .half = scale * body.half_length,
                                         .radius = radius,
                                         .growth = growth,
                                         .wall = plane,
                                         .turns = turns_at(gas.clock, wall, record.time),
                                         .touching = touching(record, i, n),
                                         .tolerance = gas.touch_tolerance(),
                                         .resolution = gas.clock.resolution()};
    const double from = gas.clock.difference(now, record.time),
                 to = gas.clock.difference(latest, record.time);
    const kernels::WallContact contact =
        trajectory ? trajectory_wall_contact(*trajectory, approach, from, to)
                   : first_wall_contact(approach, from, to);
    if (!contact.found) continue;
    Time time = std::max(now, gas.clock.add(record.time, contact.elapsed));
    // What a halt brings about is a hit on a wall at rest, however its time is rounded: it would
    // else leave the body where it is, to hit again at once.
    if (contact.elapsed >= plane.halt) {
      const double step = std::max(gas.clock.resolution(), 0x1p-52 * contact.elapsed);
      while (!wall.edge.is_at_rest(gas.clock.exact_difference(time, {})))
        time = gas.clock.add(time, step);
    }
    if (time > latest || (out.time != Time::never() && time == out.time)) continue;
    out.time = latest = time;
    out.detail = static_cast<std::int8_t>(2 * n + static_cast<std::size_t>(contact.tip));
    out.resolvable = !contact.unresolvable && !contact.across;
  }
  return out;
}

// Draws velocities of this temperature and shifts them along the direction of an impulse, so that
// the tip leaves with the flux-weighted distribution.
void Walls::leave_with_temperature(const NeedleAt& at, const Wall& wall, const Vec3d& normal,
                                   double arm, SourceOutcome& outcome) {
  const Body& body = at.body;
  const double temperature = wall.temperature, inertia = body.inertia;
  const double share = component(at.director, wall.plane.axis);
  const double mobility = mobility_of(body, arm, share);
  NeedleRandom random(seed_, at.id.value, RandomFor::thermal_wall, (*draws_)[at.needle]++);
  const Vec3d v = vector_of(random.normal()) * std::sqrt(temperature / body.mass);
  const double spread = body.turns() ? std::sqrt(temperature / inertia) : 0;
  const Vec3d w = turned(body, vector_of(random.normal()) * spread, at.director);
  // Along the normal, where the wall's own motion has no part.
  const double drawn = dot(v + cross(w, at.director) * arm, normal);
  const double leaving = std::sqrt(2 * temperature * mobility * random.exponential());
  const double impulse = (leaving - drawn) / mobility;
  outcome.velocity = v + normal * (impulse / body.mass);
  if (!(wall.sliding == Vec3d{})) outcome.velocity = outcome.velocity + wall.sliding;
  outcome.angular_velocity = w + turn_by(body, at.director, normal, arm, impulse);
  // The impulse that the wall has given, along its normal and besides.
  outcome.impulse = (outcome.velocity - at.velocity) * body.mass;
  const auto energy = [&](const Vec3d& its_v, const Vec3d& its_w) {
    return 0.5 * (body.mass * dot(its_v, its_v) + inertia * dot(its_w, its_w));
  };
  outcome.energy_change =
      energy(outcome.velocity, outcome.angular_velocity) - energy(at.velocity, at.angular_velocity);
}

SourceOutcome Walls::happen(const Gas& gas, const NeedleAt& at, std::int8_t detail) {
  const auto n = static_cast<std::size_t>(detail / 2);
  const Wall& wall = walls_[n];
  const Body& body = at.body;
  const double scale = gas.scale_at(at.now);
  const double arm = sign_of(detail % 2) * (scale * body.half_length);
  const double sign = wall.plane.normal;
  const Vec3d normal{wall.plane.axis == 0 ? sign : 0, wall.plane.axis == 1 ? sign : 0,
                     wall.plane.axis == 2 ? sign : 0};
  const double surface =
      kernels::surface_at(plane_at(gas.clock, wall, at.now), turns_at(gas.clock, wall, at.now))
          .velocity;
  const double tip = dot(at.velocity + cross(at.angular_velocity, at.director) * arm, normal);
  SourceOutcome out;
  out.changes_motion = true;
  out.object = static_cast<std::uint32_t>(n);
  out.arm = arm;
  // How fast growth brings the body's surface to the wall: what the distance of the centre from
  // the wall grows by.
  double growth = 0;
  if (gas.growth) {
    growth =
        gas.growth->relative_rate(scale) * (scale * body.radius - arm * dot(at.director, normal));
  }
  const double approach = std::min(0.0, (tip - growth) - sign * surface);
  out.normal_velocity = approach + growth;
  if (contact_time_.rule) {
    const bool is_strike = contact_time_.elastic_strikes && at.record.is_sliding();
    out.contact_time_rule = !(wall.temperature > 0) &&
                            (is_strike || contact_time_.rule->is_recent(
                                              at.needle, at.now, *contact_time_.contact_time));
    contact_time_.rule->collided(at.needle, at.now);
  }
  if (wall.temperature > 0) {
    leave_with_temperature(at, wall, normal, arm, out);
    out.normal_impulse = dot(out.impulse, normal);
    out.work = dot(out.impulse, wall.sliding);
  } else {
    const double mobility = mobility_of(body, arm, component(at.director, wall.plane.axis));
    const double epsilon = out.contact_time_rule ? 1 : wall.epsilon;
    const double impulse = -(1 + epsilon) * approach / mobility;
    out.velocity = at.velocity + normal * (impulse / body.mass);
    out.angular_velocity = at.angular_velocity + turn_by(body, at.director, normal, arm, impulse);
    out.impulse = normal * impulse;
    out.normal_impulse = impulse;
    out.work = impulse * (sign * surface);
    out.growth_work = impulse * growth;
    // A sphere that does not rebound from a wall moves with it from then on, to the last digit.
    if (wall.edge.moves() && epsilon == 0 && !body.has_axis())
      set_component(out.velocity, wall.plane.axis, surface);
    out.energy_change = impulse * (tip + 0.5 * impulse * mobility);
  }
  // Tips that have hit walls at this instant are still there. A sphere has both in one place.
  const std::uint64_t before = touching_[at.needle];
  const bool same_instant = before >> bits_of_tips == at.record.serial && at.record.time == at.now;
  const std::uint64_t tips = same_instant ? before & ((1u << bits_of_tips) - 1) : 0;
  touching_[at.needle] =
      std::uint64_t{at.record.serial + 1u} << bits_of_tips | tips |
      (body.has_axis() ? std::uint64_t{1} << detail : std::uint64_t{3} << (2 * n));
  return out;
}

std::string Walls::message(const Gas& gas, const NeedleAt& at, std::int8_t detail) const {
  const Wall& wall = walls_[static_cast<std::size_t>(detail / 2)];
  const char axis = static_cast<char>('x' + wall.plane.axis);
  const char* side = wall.plane.normal > 0 ? "low" : "high";
  const double time = gas.clock.since_start(at.now);
  if (touching(at.record, at.needle, static_cast<std::size_t>(detail / 2)) == 0) {
    return fmt::format("needle {} at time {:.17g} lies across the {} wall of axis {}", at.id.value,
                       time, side, axis);
  }
  return fmt::format(
      "collapse of needle {} at the {} wall of axis {} at time {:.17g}, back after {:.3g}: its "
      "next "
      "bounce is below what double resolves; {}",
      at.id.value, side, axis, time, gas.clock.difference(at.now, at.record.time),
      wall.epsilon == 0    ? "with epsilon = 0 there is no rebound, and no contact time can help"
      : contact_time_.rule ? contact_time_.advice
                           : "set collisions.tc_relative, to 1e-3 say");
}

}  // namespace needlework
