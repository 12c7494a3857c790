// The events of pairs where needles slide on each other: collisions, the steps of a contact, its
// end, and what becomes of it when another event has cut it (src/effects/sliding/sliding.h).
//
// The second half of event_processor.h, which includes this.
#pragma once

namespace needlework {

template <Search S, Model M>
void EventProcessor<S, M>::touch(const Event& event) {
  const Needle a = event.lower(), b = event.higher();
  count_at_instant(a, b);
  const auto pair = model_.pair(a, gas_.records[a], b, gas_.records[b], event.shift);
  const DoubleDouble elapsed =
      gas_.clock.exact_difference(now(), Gas::start_of(gas_.records[a], gas_.records[b]));
  const kernels::ContactGeometry contact = model_.contact().geometry(pair, elapsed);
  const Restitution rule = model_.restitution(gas_.records[a], gas_.records[b]);
  using Course = Sliding::Course;
  const Sliding::Touch touch = run_.sliding->touch(gas_, pair, now(), contact, event.side, rule,
                                                   run_.windows.mean_free_time());
  const bool was_whole = pair.bond == SlidingPair::Bond::whole;
  if (was_whole && touch.end == kernels::SlidingEnd::Unresolvable) {
    --tally_.at_instant;
    refuse_parallel(event);
  }

  const bool is_collision = touch.course == Course::collides || touch.course == Course::enters;
  const bool joins = touch.course == Course::enters || touch.course == Course::goes_on;
  SlidingTally& counts = tally_.sliding;
  Happening happening;
  Collision& report = happening.event;
  set_time(report);
  report.first = gas_.ids[a].value;
  report.second = gas_.ids[b].value;
  report.shift = event.shift;
  report.arm_first = contact.arm_first;
  report.arm_second = contact.arm_second;
  report.sin_angle = contact.sin_angle;
  report.normal_velocity = touch.normal_velocity;
  report.impulse = {touch.impulse.x, touch.impulse.y, touch.impulse.z};
  report.energy_change = touch.energy_change;
  const auto species = std::pair(gas_.records[a].species, gas_.records[b].species);
  const double in_contact = gas_.clock.difference(now(), gas_.records[a].time);

  const SlidingTally before = counts;
  Shift wraps_a, wraps_b;
  try {
    if (pair.bond != SlidingPair::Bond::whole) {
      cut_contacts_of(a, gas_.ids[b]);
      cut_contacts_of(b, gas_.ids[a]);
    }
    wraps_a = replace_record(a, [&] { return model_.renew_from(a, now(), touch.first); });
    wraps_b = replace_record(b, [&] { return model_.renew_from(b, now(), touch.second); });
  } catch (const InvalidStateError&) {
    predictor_.put_back();
    counts = before;
    --tally_.at_instant;
    throw;
  }
  const Shift shift = event.shift + wraps_b - wraps_a;
  if (joins) {
    Sliding::join(gas_, a, b, shift, touch.side);
  } else {
    const kernels::Touch parted{
        .touching = true, .collided = true, .side = touch.side_after, .gap = 0};
    gas_.add_touch(a, RecordedTouch::of(gas_.ids[b], gas_.records[b].serial, shift, parted));
    gas_.add_touch(b, RecordedTouch::of(gas_.ids[a], gas_.records[a].serial, -shift, parted));
  }
  run_.sliding->met(gas_, a, b, now(), touch.crowded);
  if (run_.contact_time_rule && is_collision) {
    run_.contact_time_rule->collided(a, now());
    run_.contact_time_rule->collided(b, now());
  }

  if (was_whole) {
    counts.time.add(std::max(0.0, in_contact));
    ++counts.steps;
    counts.by_force += touch.end == kernels::SlidingEnd::Force;
    counts.by_tip += touch.end == kernels::SlidingEnd::Tip;
  } else if (touch.course == Course::goes_on) {
    --counts.by_strike;  // what has cut the contact was no end of it
  } else {
    counts.entered += joins;
  }
  counts.crowded += touch.raised;
  tally_.energy += run_.energy.in_quanta(touch.energy_change);
  if (is_collision) {
    ++tally_.collisions;
    if (gas_.composition.is_mixture()) {
      tally_.count(tally_.by_pair, gas_.composition.pair_index(species.first, species.second),
                   gas_.composition.pairs());
    }
  }
  happening.kind = touch.course == Course::enters  ? Happening::contact_entered
                   : touch.course == Course::parts ? Happening::contact_ended
                                                   : Happening::pair;
  if (happening.kind == Happening::pair && !joins) {
    tally_.hash.add(report);
  } else {
    tally_.hash.add(report, static_cast<std::uint8_t>(joins ? Happening::contact_entered
                                                            : Happening::contact_ended));
  }
  const Time placed_a = place(a), placed_b = place(b);
  const double apart =
      model_.contact().time_apart(model_.pair(a, gas_.records[a], b, gas_.records[b], shift));
  schedule(a, placed_a, {b, shift, apart});
  schedule(b, placed_b, {a, -shift, apart});
  if (!run_.listeners.any()) return;
  // Needles that collide as their contact has been cut have ended it before.
  if (is_collision && pair.bond == SlidingPair::Bond::cut) {
    Happening ended = happening;
    ended.kind = Happening::contact_ended;
    ended.event.impulse = {};
    ended.event.energy_change = 0;
    run_.listeners.report(gas_, ended, a, b, reports);
  }
  const bool is_told = is_collision || touch.course == Course::parts;
  if (is_told) run_.listeners.report(gas_, happening, a, b, reports);
}

// An event is about to replace the record of needle i, which may slide on another needle than that
// of the event. An event of that pair is then due at once.
template <Search S, Model M>
void EventProcessor<S, M>::cut_contacts_of(Needle i, std::optional<Id> but) {
  const Record& record = gas_.records[i];
  if (!record.is_sliding() || record.first_touch.partner == but) return;
  ++tally_.sliding.by_strike;
  tally_.sliding.time.add(std::max(0.0, gas_.clock.difference(now(), record.time)));
}

template <Search S, Model M>
void EventProcessor<S, M>::refuse_parallel(const Event& event) const {
  throw InvalidStateError(
      fmt::format("needles {} and {} slide on each other at time {:.17g} and are so nearly "
                  "parallel that their motion cannot be resolved",
                  event.lower_id.value, event.higher_id.value, gas_.clock.since_start(event.time)),
      {{event.lower_id.value, event.higher_id.value}});
}

}  // namespace needlework
