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
      meetings_(
          &gas.columns.add<Meetings>("meetings", {{}, Meetings::long_ago, Meetings::long_ago, 0})) {
  gas.let_slide();
}

// Whether one of the two is in contact with a third needle, or has touched one within this time.
bool Sliding::is_crowded(const Gas& gas, const SlidingPair& pair, Time now, double within) const {
  const auto is_with_another = [&](Needle i, Id other) {
    const Record& record = gas.records[i];
    if (record.is_sliding() && record.first_touch.partner != other) return true;
    return gas.clock.difference(now, (*meetings_)[i].but(other)) < within;
  };
  return is_with_another(pair.first_needle, gas.ids[pair.second_needle]) ||
         is_with_another(pair.second_needle, gas.ids[pair.first_needle]);
}

// Whether one of the two is in contact, or has touched anything at this very instant.
bool Sliding::is_strike(const Gas& gas, const SlidingPair& pair, Time now) const {
  const auto touches = [&](Needle i) {
    return gas.records[i].is_sliding() || gas.clock.difference(now, (*meetings_)[i].with_last) == 0;
  };
  return touches(pair.first_needle) || touches(pair.second_needle);
}

Sliding::Touch Sliding::touch(const Gas& gas, const SlidingPair& pair, Time now,
                              const kernels::ContactGeometry& geometry, int side,
                              const Restitution& rule, double mean_free_time) const {
  using Bond = SlidingPair::Bond;
  const Needle a = pair.first_needle, b = pair.second_needle;
  const Record &mine = gas.records[a], &other = gas.records[b];
  const kernels::SlidingBodies bodies = sliding_bodies(gas, mine, other);
  Touch out;
  out.side = out.side_after = side;
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
    out.side_after = to;
    if (!(speed * to > least)) push((to * 2 * least - speed) / contact.inverse);
  };
  const double speed = contact.speed;
  if (pair.bond == Bond::whole) {
    out.end = pair.joint().step.end;
    // What rounding has added to f' is taken off.
    if (out.end == SlidingEnd::None) {
      push(-speed / contact.inverse);
      out.course = Course::goes_on;
    } else {
      part_to(kernels::side_after(out.end, side), speed);
      out.course = Course::parts;
    }
    return out;
  }
  if (pair.bond == Bond::cut && speed * side >= -least) {
    // The strike has not changed how the two move on each other, or it has torn them apart.
    const bool is_pressed = side * contact.force > contact.noise;
    const bool stays = std::abs(speed) <= least && is_pressed && contact.rate > 0;
    out.course = stays ? Course::goes_on : Course::parts;
    if (stays)
      push(-speed / contact.inverse);
    else
      part_to(side, speed);
    return out;
  }
  const double into = speed * side < 0 ? speed : 0;
  const double below = parameters_.below * mean_free_time;
  // Twice the threshold, as flights of crowded pairs last for about that.
  const bool crowded = is_crowded(gas, pair, now, 2 * below);
  const bool elastic = parameters_.elastic_strikes && is_strike(gas, pair, now);
  double epsilon = rule.epsilon;
  if (into != 0 && !elastic) {
    const kernels::SlidingEntry entry =
        kernels::sliding_entry(bodies, here, rule.epsilon, below, crowded);
    if (entry.decision == kernels::SlidingDecision::Enters) out.course = Course::enters;
    epsilon = entry.epsilon;
  }
  out.crowded = crowded;
  const std::uint32_t in_crowd = std::max((*meetings_)[a].in_crowd, (*meetings_)[b].in_crowd);
  if (elastic || (crowded && in_crowd >= most_in_crowd)) epsilon = 1;
  out.raised = epsilon != rule.epsilon;
  if (out.course == Course::enters) epsilon = 0;
  const Meeting both{out.first.v,
                     out.first.w,
                     out.second.v,
                     out.second.w,
                     gas.bodies[mine.species],
                     gas.bodies[other.species],
                     geometry,
                     side};
  const Impact impact = collide<Surface::smooth>(both, {.epsilon = epsilon, .beta = -1});
  out.first.v = impact.v_first, out.first.w = impact.w_first;
  out.second.v = impact.v_second, out.second.w = impact.w_second;
  if (out.course == Course::collides) part_to(side, -epsilon * into);
  out.impulse = impact.impulse;
  out.normal_velocity = impact.normal_velocity;
  out.energy_change = impact.energy_change;
  return out;
}

void Sliding::met(const Gas& gas, Needle a, Needle b, Time now, bool crowded) {
  (*meetings_)[a].met(gas.ids[b], now, crowded);
  (*meetings_)[b].met(gas.ids[a], now, crowded);
}

void Sliding::join(Gas& gas, Needle a, Needle b, const Shift& shift, int side) {
  const Record &first = gas.records[a], &second = gas.records[b];
  const Slide slide = make_slide(gas, first, second, shift, side);
  kernels::Touch touch{.touching = true, .collided = true, .side = 2 * side, .gap = 0};
  gas.slides->put(gas.ids[a], first.serial, slide);
  touch.gap = slide.faster[0];
  const auto of_first = RecordedTouch::of(gas.ids[b], second.serial, shift, touch);
  touch.gap = slide.faster[1];
  const auto of_second = RecordedTouch::of(gas.ids[a], first.serial, -shift, touch);
  gas.add_touch(a, of_first);
  gas.add_touch(b, of_second);
}

}  // namespace needlework
