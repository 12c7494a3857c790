#include "src/effects/sliding/sliding.h"

#include <algorithm>
#include <cmath>

#include "kernels/sliding_entry.h"

namespace needlework {
namespace {

using kernels::SlidingEnd;

// Relative to the needles' speeds: below this, the velocity at which they part is rounding. More
// than what first_contact() takes for a return at once.
constexpr double velocity_noise = 0x1p-44;

// Of collisions in a crowd, so many are done with epsilon, far more than a strike needs where
// epsilon is above 1/4. Then they are elastic, so that needles which lock each other in push each
// other apart.
constexpr std::uint32_t most_in_crowd = 8;

double length_of(const Vec3d& a) { return std::sqrt(dot(a, a)); }

}  // namespace

Sliding::Sliding(Gas& gas, const Parameters& parameters)
    : parameters_(parameters),
      last_touches_(&gas.columns.add<LastTouches>(
          "meetings", {{}, LastTouches::long_ago, LastTouches::long_ago, 0})) {
  gas.let_slide();
}

// Whether one of the two is in contact with a third needle, or has touched one within this time.
bool Sliding::is_crowded(const Gas& gas, const SlidingPair& pair, Time now, double within) const {
  const auto is_with_another = [&](Needle i, Id other) {
    const Record& record = gas.records[i];
    if (record.is_sliding() && record.first_touch.partner != other) return true;
    return gas.clock.difference(now, (*last_touches_)[i].but(other)) < within;
  };
  return is_with_another(pair.first_needle, gas.ids[pair.second_needle]) ||
         is_with_another(pair.second_needle, gas.ids[pair.first_needle]);
}

// Whether one of the two is in contact, or has touched anything at this very instant.
bool Sliding::is_strike(const Gas& gas, const SlidingPair& pair, Time now) const {
  const auto touches = [&](Needle i) {
    return gas.records[i].is_sliding() ||
           gas.clock.difference(now, (*last_touches_)[i].with_last) == 0;
  };
  return touches(pair.first_needle) || touches(pair.second_needle);
}

Sliding::Outcome Sliding::outcome(const Gas& gas, const Due& due) const {
  const Needle a = due.pair.first_needle, b = due.pair.second_needle;
  Outcome out = decided(gas, due);
  if (out.bond_before == SlidingPair::Bond::whole) {
    out.step = std::max(0.0, gas.clock.difference(due.now, gas.records[a].time));
    return out;
  }
  const auto cut = [&](Needle i, Needle other) -> std::optional<double> {
    if (gas.records[i].first_touch.partner == gas.ids[other]) return std::nullopt;
    return cut_by_event(gas, i, due.now);
  };
  out.cut_first = cut(a, b);
  out.cut_second = cut(b, a);
  return out;
}

std::optional<double> Sliding::cut_by_event(const Gas& gas, Needle i, Time now) {
  const Record& record = gas.records[i];
  if (!record.is_sliding()) return std::nullopt;
  return std::max(0.0, gas.clock.difference(now, record.time));
}

Sliding::Outcome Sliding::decided(const Gas& gas, const Due& due) const {
  using Bond = SlidingPair::Bond;
  const auto& [pair, now, geometry, side, rule, mean_free_time] = due;
  const Needle a = pair.first_needle, b = pair.second_needle;
  const kernels::SlidingBodies bodies = sliding_bodies(gas, a, b);
  Outcome out;
  out.bond_before = pair.bond;
  out.side = side;
  out.first = gas.present(a, now);
  out.second = gas.present(b, now);
  out.first.u = geometry.u_first;
  out.second.u = geometry.u_second;
  const Vec3d image = to_double(pair.shift);
  const kernels::SlidingState here{(out.first.r - out.second.r) - image,
                                   out.first.v - out.second.v,
                                   out.first.u,
                                   out.second.u,
                                   out.first.w,
                                   out.second.w};
  const kernels::SlidingContact contact = kernels::sliding_contact(bodies, here);
  const double speeds = length_of(here.v) + (length_of(here.w_first) + length_of(here.w_second)) *
                                                (bodies.first.half + bodies.second.half);
  // An impulse along the normal, on the first needle.
  const auto push = [&](double impulse) {
    const Vec3d along = contact.normal * impulse;
    out.first.v += along * (1 / bodies.first.mass);
    out.second.v -= along * (1 / bodies.second.mass);
    out.first.w += cross(out.first.u, along) * (contact.arm_first / bodies.first.inertia);
    out.second.w -= cross(out.second.u, along) * (contact.arm_second / bodies.second.inertia);
  };
  // Needles that part do so faster than rounding.
  const double least = velocity_noise * speeds;
  const auto part_to = [&](int to, double speed) {
    out.side = to;
    if (!(speed * to > least)) push((to * 2 * least - speed) / contact.inverse);
  };
  const double speed = contact.speed;
  if (pair.bond == Bond::whole) {
    out.end = pair.joint().step.end;
    // What rounding has added to f' is taken off.
    if (out.end == SlidingEnd::None) {
      push(-speed / contact.inverse);
      out.bond = BondChange::continues;
    } else {
      part_to(kernels::side_after(out.end, side), speed);
      out.bond = BondChange::ends;
    }
    out.collides = false;
    return out;
  }
  if (pair.bond == Bond::cut && speed * side >= -least) {
    // The strike has not changed how the two move on each other, or it has torn them apart.
    const bool is_pressed = side * contact.force > contact.noise;
    const bool stays = std::abs(speed) <= least && is_pressed && contact.rate > 0;
    out.bond = stays ? BondChange::continues : BondChange::ends;
    if (stays)
      push(-speed / contact.inverse);
    else
      part_to(side, speed);
    out.collides = false;
    return out;
  }
  if (pair.bond == Bond::cut) out.bond = BondChange::ends;
  const double into = speed * side < 0 ? speed : 0;
  const double below = parameters_.below * mean_free_time;
  // Twice the threshold, as flights of crowded pairs last for about that.
  const bool crowded = is_crowded(gas, pair, now, 2 * below);
  const bool elastic = parameters_.elastic_strikes && is_strike(gas, pair, now);
  double epsilon = rule.epsilon;
  if (into != 0 && !elastic) {
    const kernels::SlidingEntry entry =
        kernels::sliding_entry(bodies, here, rule.epsilon, below, crowded);
    if (entry.decision == kernels::SlidingDecision::Enters) out.bond = BondChange::begins;
    epsilon = entry.epsilon;
  }
  out.crowded = crowded;
  const std::uint32_t in_crowd =
      std::max((*last_touches_)[a].in_crowd, (*last_touches_)[b].in_crowd);
  if (elastic || (crowded && in_crowd >= most_in_crowd)) epsilon = 1;
  out.raised = epsilon != rule.epsilon;
  if (out.are_bonded()) epsilon = 0;
  const CollidingPair both{out.first.v, out.first.w, out.second.v, out.second.w,
                           gas.body(a), gas.body(b), geometry,     side};
  const Impact impact = collide<Surface::smooth>(both, {.epsilon = epsilon, .beta = -1});
  out.first.v = impact.v_first, out.first.w = impact.w_first;
  out.second.v = impact.v_second, out.second.w = impact.w_second;
  if (!out.are_bonded()) part_to(side, -epsilon * into);
  out.impulse = impact.impulse;
  out.normal_velocity = impact.normal_velocity;
  out.energy_change = impact.energy_change;
  return out;
}

void Sliding::join(Gas& gas, Needle a, Needle b, const Shift& shift, int side) {
  const Id first = gas.ids[a], second = gas.ids[b];
  const std::uint32_t serial_first = gas.records[a].serial, serial_second = gas.records[b].serial;
  const Slide slide = make_slide(gas, a, b, shift, side);
  gas.slides->put(first, serial_first, slide);
  gas.add_touch(a, RecordedTouch::bond(second, serial_second, shift, side, slide.faster[0]));
  gas.add_touch(b, RecordedTouch::bond(first, serial_first, -shift, side, slide.faster[1]));
}

void Sliding::settle(Gas& gas, Needle a, Needle b, const Shift& shift, Time now,
                     const Outcome& outcome, SlidingTally& tally) {
  if (outcome.are_bonded()) {
    join(gas, a, b, shift, outcome.side);
  } else {
    part(gas, a, b, shift, outcome.side);
  }
  (*last_touches_)[a].met(gas.ids[b], now, outcome.crowded);
  (*last_touches_)[b].met(gas.ids[a], now, outcome.crowded);
  if (outcome.cut_first) tally.cut(*outcome.cut_first);
  if (outcome.cut_second) tally.cut(*outcome.cut_second);
  tally.crowded += outcome.raised;
  if (outcome.step) {
    tally.time.add(*outcome.step);
    ++tally.steps;
    tally.by_force += outcome.end == SlidingEnd::Force;
    tally.by_tip += outcome.end == SlidingEnd::Tip;
  } else if (outcome.bond == BondChange::continues) {
    --tally.by_strike;  // what has cut the contact was no end of it
  } else {
    tally.entered += outcome.are_bonded();
  }
}

}  // namespace needlework
