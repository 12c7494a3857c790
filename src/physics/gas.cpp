#include "src/physics/gas.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kernels/power_of_two.h"
#include "needlework/error.h"
#include "src/physics/director.h"
#include "src/physics/vectors.h"

namespace needlework {
namespace {

// Looks for the touch with the other's record among those after the first.
[[gnu::noinline]] bool find_further_touch(const Gas& gas, Needle i, const Record& record,
                                          Id partner, const Record& other, const Shift& shift,
                                          kernels::Touch& out) {
  for (const RecordedTouch& touch : gas.further_touches->of(gas.ids[i], record.serial)) {
    if (!touch.is_with(partner, other.serial, shift)) continue;
    out = touch.touch();
    return true;
  }
  return false;
}

// Sets `out` to the touch of needle i's record with the other's record, if there is one.
[[gnu::always_inline]] inline bool find_touch(const Gas& gas, Needle i, const Record& record,
                                              Needle partner, const Record& other,
                                              const Shift& shift, kernels::Touch& out) {
  if (record.touch_count == 0) return false;
  const RecordedTouch& first = record.first_touch;
  const Id id = gas.ids[partner];
  if (first.is_with(id, other.serial, shift)) {
    out = first.touch();
    return true;
  }
  return record.touch_count > 1 && find_further_touch(gas, i, record, id, other, shift, out);
}

// Both fall alike from the start on, and the earlier record has fallen until then. Kept out of the
// code of gases without gravity.
[[gnu::noinline]] void add_fall(kernels::Pair& pair, const Vec3d& gravity) {
  const bool first_is_earlier = !(pair.elapsed_first == DoubleDouble());
  const DoubleDouble elapsed = first_is_earlier ? pair.elapsed_first : pair.elapsed_second;
  const Vec3dd gain = to_double_double(gravity) * elapsed;
  const Vec3dd fall = gain * (elapsed * DoubleDouble(0.5));
  const kernels::Fall its =
      first_is_earlier ? kernels::Fall{gain, fall} : kernels::Fall{-gain, -fall};
  pair.fall = pair.fall ? kernels::Fall{pair.fall->velocity + its.velocity, its.place} : its;
}

// An image that flies past, of a needle that does not fall.
[[gnu::noinline]] void slide(kernels::Pair& pair, const Gas& gas, Time start, const Shift& shift) {
  const Image<DoubleDouble> image = gas.box_at(start).image<DoubleDouble>(shift);
  pair.shift = image.place;
  if (image.velocity.x != 0) pair.fall = {-to_double_double(image.velocity), {}};
}

[[noreturn, gnu::cold]] void refuse_boxes(Id id) {
  throw InvalidStateError("needle " + std::to_string(id.value) + " crosses more than " +
                              std::to_string(most_boxes) +
                              " boxes along one axis, the most that are counted: expected an "
                              "earlier end of the run, or a larger box",
                          {{id.value, id.value}});
}

// By how much coordinates along axes with walls exceed the edges. [L]
double outside_box(const Box& box, const Vec3d& place) {
  const double coordinates[] = {place.x, place.y, place.z};
  double out = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!box.is_periodic(axis)) out += std::max(0.0, std::abs(coordinates[axis]) - box.edge(axis));
  }
  return out;
}

}  // namespace

kernels::Pair make_pair(const Gas& gas, Needle a, const Record& record_a, Needle b,
                        const Record& record_b, const Shift& shift) {
  kernels::Pair pair;
  pair.first = &record_a.flight;
  pair.second = &record_b.flight;
  const Time start = Gas::start_of(record_a, record_b);
  if (record_a.time != start) pair.elapsed_first = gas.clock.exact_difference(start, record_a.time);
  if (record_b.time != start)
    pair.elapsed_second = gas.clock.exact_difference(start, record_b.time);
  if (!same(shift, Shift{})) {
    if (gas.shear)
      slide(pair, gas, start, shift);
    else
      pair.shift = gas.box.image<DoubleDouble>(shift).place;
  }
  pair.touch_within = gas.touch_tolerance();
  if (gas.falls) {
    add_fall(pair, gas.gravity);
    // Beyond an open side, to which needles come that fall back, coordinates round more than in the
    // box.
    pair.touch_within += 0x1p-44 * std::max(outside_box(gas.box, record_a.flight.r),
                                            outside_box(gas.box, record_b.flight.r));
  }
  // The touch is in the later record. If both records were made at the same time, it may be in
  // either.
  const bool found =
      record_a.time == start && find_touch(gas, a, record_a, b, record_b, shift, pair.touch);
  if (!found && record_b.time == start) {
    find_touch(gas, b, record_b, a, record_a, -shift, pair.touch);
  }
  return pair;
}

void Gas::set_composition(Composition its_composition) {
  composition = std::move(its_composition);
  look_up_bodies();
}

void Gas::look_up_bodies() {
  longest = composition.longest() * (slides ? 1 + 2 * most_departure : 1);
  bodies_.clear();
  for (std::size_t n = 0; n < composition.size(); ++n) {
    bodies_.push_back(as_in_this_gas(body_of(composition[n]), n));
  }
}

void Gas::add_touch(Needle i, const RecordedTouch& touch) {
  Record& record = records[i];
  if (record.touch_count == 0) {
    record.first_touch = touch;
  } else {
    further_touches->add(ids[i], record.serial, record.touch_count - 1u, touch);
  }
  ++record.touch_count;
}

void part(Gas& gas, Needle first, Needle second, const Shift& shift, int side) {
  const kernels::Touch touch{.touching = true, .collided = true, .side = side, .gap = 0};
  const Id first_id = gas.ids[first], second_id = gas.ids[second];
  const std::uint32_t serials[] = {gas.records[first].serial, gas.records[second].serial};
  gas.add_touch(first, RecordedTouch::of(second_id, serials[1], shift, touch));
  gas.add_touch(second, RecordedTouch::of(first_id, serials[0], -shift, touch));
}

Shift add_boxes(const Gas& gas, Needle i, const Boxes& boxes) {
  const Shift& image = gas.images[i];
  Shift out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double sum = image[axis] + boxes[axis];
    if (!(std::abs(sum) <= most_boxes) && !(gas.shear && axis == 0)) refuse_boxes(gas.ids[i]);
    out[axis] = static_cast<std::int32_t>(static_cast<std::int64_t>(sum));
  }
  return out;
}

void Gas::let_slide() {
  slides = std::make_unique<Slides>();
  look_up_bodies();
  margin = 2 * most_departure * composition.longest();
}

kernels::BodyState Gas::present(Id id, const Record& record, Time now) const {
  const Slide* slide = slides && record.is_sliding() ? slides->of(id, record) : nullptr;
  return NeedleTrajectory(*this, id, record, slide, clock.difference(now, record.time)).at(0);
}

void set_rotation(kernels::Flight& flight, const Body& body) {
  if (body.has_axis()) {
    kernels::set_rotation(flight);
  } else {
    flight.p = {};
    flight.omega = 0;
  }
}

namespace {

// With the centre wrapped, and the velocity of that image.
[[gnu::always_inline]] inline Shift renew_with(Gas& gas, Needle i, Time now,
                                               const kernels::BodyState& state, const Body& body,
                                               const Wrapped& wrapped, const Vec3d& velocity) {
  Record& record = gas.records[i];
  const auto& [place, boxes] = wrapped;
  gas.images[i] = add_boxes(gas, i, boxes);
  record.flight.r = vector_of(place);
  record.flight.u = normalised(state.u);
  record.flight.v = velocity;
  record.flight.w = turned(body, state.w, record.flight.u);
  set_rotation(record.flight, body);
  record.time = now;
  record.renewal = renewal_time(gas, record, body.extent());
  record.touch_count = 0;
  ++record.serial;
  return shift_of(boxes);
}

[[gnu::noinline]] Shift renew_in_rows(Gas& gas, Needle i, Time now, const kernels::BodyState& state,
                                      const Body& body) {
  const Box box = gas.box_at(now);
  const Wrapped wrapped = box.wrap(to_array(state.r));
  return renew_with(gas, i, now, state, body, wrapped, state.v - box.image(wrapped.boxes).velocity);
}

}  // namespace

Shift renew_record(Gas& gas, Needle i, Time now, const kernels::BodyState& state,
                   const Body& body) {
  if (gas.shear) return renew_in_rows(gas, i, now, state, body);
  return renew_with(gas, i, now, state, body, gas.box.wrap_at_rest(to_array(state.r)), state.v);
}

}  // namespace needlework
