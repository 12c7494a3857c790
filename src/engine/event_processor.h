// Processes events: replaces records, and predicts the next events of the needles concerned.
//
// Each needle has one event in the calendar: the earliest contact that its own last search found,
// or the horizon at which that search ended. A contact is stored only with the needle that
// predicted it. If the partner's record has been replaced since then, the contact is stale, and
// its owner searches again at the time of the contact. So a search that stopped at a contact is
// continued from there, whether or not the contact takes place.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/calendar/any_calendar.h"
#include "src/effects/sliding/sliding_events.h"
#include "src/engine/collapse.h"
#include "src/engine/pair_collisions.h"
#include "src/engine/pair_predictor.h"
#include "src/engine/rollback_log.h"
#include "src/engine/run.h"
#include "src/engine/tally.h"
#include "src/memory/prefetch.h"
#include "src/physics/model.h"
#include "src/search/search.h"

namespace needlework {

/// Processes the events of one thread. Search, calendar and tally belong to the thread; all
/// threads share the run.
template <Search S, Model M>
class EventProcessor {
 public:
  EventProcessor(Run& run, const M& model, S& search, EventSink& calendar, Tally& tally)
      : run_(run),
        gas_(run.gas),
        model_(model),
        search_(search),
        calendar_(calendar),
        tally_(tally),
        predictor_(model, tally.counters),
        pair_events_(run, model) {}

  Time now() const { return predictor_.now; }
  void set_now(Time time) { predictor_.now = time; }

  /// Whether the event is a contact whose partner's record has been replaced since the prediction.
  bool is_stale(const Event& event) const {
    return event.is_contact() && gas_.records[event.partner].serial != event.partner_serial;
  }
  /// Processes the event.
  void process(const Event& event, bool stale);
  /// Enters needle i into the search where it is now. Returns until when it is found there.
  Time place(Needle i) { return search_.place(i, now(), model_.half_length(i)); }
  /// Searches the next contact of needle i from now on and puts its next event into the calendar.
  /// `just_hit` is the needle with which it has just collided, if any.
  [[gnu::noinline]] void schedule(Needle i, Time placed_until, const JustHit& just_hit = {});
  /// Whether other threads read the records as well, so that none may be changed.
  void share_records(bool shared) { predictor_.shares_records = shared; }
  /// The first half of schedule(), for several threads that search for different needles: changes
  /// nothing that others read. Throws UnfinishedEventError where a record would have to be.
  [[gnu::noinline]] Event find(Needle i, Time placed_until) {
    return next_event(i, placed_until, {});
  }
  /// The second half.
  void enter_found(const Event& event) {
    search_.set_next_event(event.owner, event.time);
    enter(event);
  }
  void enter(const Event& event) { calendar_.set(event, cell_of(event.owner)); }
  /// Prefetches what the processing of an event of this needle will read.
  void prefetch(Needle i) const {
    needlework::prefetch(&gas_.records[i]);
    needlework::prefetch(&gas_.ids[i]);
    needlework::prefetch(&gas_.images[i]);
    if constexpr (M::has_effects) gas_.columns.prefetch(i);
    search_.prefetch(i);
  }
  /// Discards cached predictions. To be called after needles have moved in storage, or after
  /// records have been put back.
  void forget() { predictor_.forget(); }
  /// Hands over the old records when a caller has just replaced some. They determine on which side
  /// of each other two needles are that touch.
  void take(ReplacedRecords replaced) { predictor_.take(std::move(replaced)); }

  RollbackLog* rollback_log = nullptr;  ///< if not null, receives what the processor replaces
  Reports* reports = nullptr;           ///< if not null, receives what happens in place of the
                                        ///< callbacks
#ifndef NDEBUG
  /// Whether a prediction has read a record that another thread has made at a later time than now,
  /// of a needle that was then near enough to the other one to touch it.
  bool has_read_ahead() const { return predictor_.read_ahead; }
  void watch_reading_ahead() { predictor_.read_ahead = false; }
#endif

 private:
  CellIndex cell_of(Needle i) const { return calendar_.needs_cell ? search_.cell_index(i) : 0; }
  Event next_event(Needle i, Time placed_until, const JustHit& just_hit);
  void consider(Needle i, Needle j, const Shift& shift, double from, Event& best);
  template <class Renew>
  Shift replace_record(Needle i, Renew&& renew);
  void horizon(Needle i);
  using PairEvents =
      std::conditional_t<M::has_sliding, SlidingPairEvents<Run, M>, PairCollisions<M>>;
  struct PairEvent {
    kernels::ContactGeometry contact;
    typename PairEvents::Outcome outcome;
    double virial = 0;  ///< r12 . dp, where bodies have a distance [energy]
    Vec3d between;      ///< r12, from the second centre to the first, with effects [L]
  };
  PairEvent pair_event(const Event& event);
  Happening happening_of(const Event& event, const PairEvent& of) const;
  // A separate function, so that a test can inspect the machine code that an effect adds.
  [[gnu::noinline]] void meet(const Event& event);
  void count(const PairEvent& event, Needle a, Needle b);
  [[gnu::noinline]] void happen(const Event& event);
  void consider_sources(Needle i, Event& best) const;
  void count_at_instant(Needle a, Needle b);
  void set_time(Collision& report) const {
    report.epoch = now().epoch;
    report.offset = now().offset;
    report.time = gas_.clock.since_start(now());
  }
  NeedleAt needle_at(Needle i) const;
  [[noreturn, gnu::noinline]] void refuse(const Event& event);
  [[noreturn]] void report_collapse(const Event& event) const;
  [[noreturn]] void report_overlap(Needle a, Needle b, const Shift& shift) const;

  Run& run_;
  Gas& gas_;
  const M& model_;
  S& search_;
  EventSink& calendar_;
  Tally& tally_;
  PairPredictor<M> predictor_;
  PairEvents pair_events_;
  std::vector<std::byte> columns_before_;  ///< values of a needle before an event of a source
};

template <Search S, Model M>
void EventProcessor<S, M>::process(const Event& event, bool stale) {
  if (!event.resolvable && !stale) refuse(event);
  ++tally_.counters.events;
  predictor_.begin(event.time);
  switch (event.kind) {
    case EventKind::horizon:
      return horizon(event.owner);
    case EventKind::contact:
      if (stale) {
        ++tally_.counters.stale;
        return schedule(event.owner, place(event.owner));
      }
      return meet(event);
    case EventKind::source:
      if constexpr (M::has_effects) happen(event);
      return;
  }
}

// A horizon is the time at which the needle leaves its bounding volume, at which its record has to
// be renewed, or up to which contacts have been searched.
template <Search S, Model M>
void EventProcessor<S, M>::horizon(Needle i) {
  if (gas_.records[i].renewal <= now()) {
    ++tally_.counters.renewals;
    replace_record(i, [&] { return model_.renew(i, now(), model_.present(i, now())); });
  } else {
    ++tally_.counters.rebuilds;
  }
  schedule(i, place(i));
}

template <Search S, Model M>
template <class Renew>
Shift EventProcessor<S, M>::replace_record(Needle i, Renew&& renew) {
  if (rollback_log) {
    rollback_log->replaced(i, gas_);
  }
  if constexpr (M::has_effects) {
    if (run_.effects.stress) {
      const FlightCarries over = flight_carries(gas_, i, now());
      const double way = gas_.peculiar_x ? gas_.way_beside_flow(i, now()) : 0;
      const Shift wraps = predictor_.replace(i, renew);
      run_.count(over, tally_);
      if (gas_.peculiar_x) (*gas_.peculiar_x)[i] += way;
      return wraps;
    }
  }
  return predictor_.replace(i, renew);
}

// What an event makes of a pair, from the records of both, which it then replaces: nothing here
// refers to them.
template <Search S, Model M>
[[gnu::always_inline]] inline typename EventProcessor<S, M>::PairEvent
EventProcessor<S, M>::pair_event(const Event& event) {
  const Needle a = event.lower(), b = event.higher();
  const Record &first = gas_.records[a], &second = gas_.records[b];
  const auto pair = model_.pair(a, first, b, second, event.shift);
  const DoubleDouble elapsed = gas_.clock.exact_difference(now(), Gas::start_of(first, second));
  PairEvent out;
  out.contact = model_.contact().geometry(pair, elapsed);
  const kernels::ContactGeometry& contact = out.contact;
  out.outcome = pair_events_.outcome(pair, a, b, event.shift, now(), contact, event.side);
  if constexpr (M::Law::has_distance) {
    // The centres are as far apart along the normal as both bodies reach from them: never below 0.
    // A contact without velocity has an impulse of -0.
    double distance = pair.distance;
    if (gas_.growth) distance *= 1 + pair.growth * elapsed.hi;
    const double apart = distance - contact.arm_first * dot(contact.u_first, contact.normal) +
                         contact.arm_second * dot(contact.u_second, contact.normal);
    out.virial = std::max(0.0, dot(out.outcome.impulse, contact.normal) * apart);
    out.between = contact.normal * distance;
  }
  if constexpr (M::has_effects) {
    out.between += contact.u_second * contact.arm_second - contact.u_first * contact.arm_first;
  }
  // Of rough needles, of either sign.
  if constexpr (M::Law::mixes) {
    if (pair.distance == 0) out.virial = dot(out.outcome.impulse, out.between);
  }
  return out;
}

template <Search S, Model M>
Happening EventProcessor<S, M>::happening_of(const Event& event, const PairEvent& of) const {
  const PairOutcome& outcome = of.outcome;
  Happening out;
  out.kind = PairEvents::kind(of.outcome);
  Collision& report = out.event;
  set_time(report);
  report.first = event.lower_id.value;
  report.second = event.higher_id.value;
  report.shift = event.shift;
  report.arm_first = of.contact.arm_first;
  report.arm_second = of.contact.arm_second;
  report.sin_angle = of.contact.sin_angle;
  report.normal_velocity = outcome.normal_velocity;
  report.impulse = {outcome.impulse.x, outcome.impulse.y, outcome.impulse.z};
  report.energy_change = outcome.energy_change;
  report.contact_time_rule = outcome.contact_time_rule;
  return out;
}

template <Search S, Model M>
void EventProcessor<S, M>::meet(const Event& event) {
  const Needle a = event.lower(), b = event.higher();
  const PairEvent of = pair_event(event);
  const auto& outcome = of.outcome;
  count_at_instant(a, b);
  Shift wraps_a, wraps_b;
  try {
    wraps_a = replace_record(a, [&] { return model_.renew(a, now(), outcome.first); });
    wraps_b = replace_record(b, [&] { return model_.renew(b, now(), outcome.second); });
  } catch (const InvalidStateError&) {
    predictor_.put_back();
    --tally_.at_instant;
    throw;
  }
  const Shift shift = event.shift + wraps_b - wraps_a;
  pair_events_.settle(a, b, shift, now(), outcome, tally_.sliding);
  count(of, a, b);
  Happening happening = happening_of(event, of);
  const Happening::Kind kind = PairEvents::kind_in_hash(outcome);
  if (kind == Happening::pair)
    tally_.hash.add(happening.event);
  else
    tally_.hash.add(happening.event, kind);
  const Time placed_a = place(a), placed_b = place(b);
  const double apart = model_.time_apart(a, b, shift);
  schedule(a, placed_a, {b, shift, apart});
  schedule(b, placed_b, {a, -shift, apart});
  if (!run_.listeners.any()) return;
  PairEvents::report(happening, outcome,
                     [&](Happening& each) { run_.listeners.report(gas_, each, a, b, reports); });
}

template <Search S, Model M>
[[gnu::always_inline]] inline void EventProcessor<S, M>::count(const PairEvent& event, Needle a,
                                                               Needle b) {
  tally_.energy += run_.energy.in_quanta(event.outcome.energy_change);
  if constexpr (M::Law::has_distance) {
    if (gas_.growth) tally_.growth += run_.energy.in_quanta(event.outcome.growth_work);
  }
  if (!event.outcome.collides) return;
  ++tally_.collisions;
  tally_.tc_collisions += event.outcome.contact_time_rule;
  if (M::has_effects && gas_.composition.is_mixture()) {
    tally_.count(tally_.by_pair,
                 gas_.composition.pair_index(gas_.records[a].species, gas_.records[b].species),
                 gas_.composition.pairs());
  }
  if constexpr (M::Law::has_distance) {
    if (tally_.virial.empty()) tally_.virial.resize(M::Law::mixes ? 2 : 1);
    if constexpr (M::Law::mixes)
      tally_.virial[event.virial < 0].add(std::abs(event.virial));
    else
      tally_.virial.front().add(event.virial);
  }
  if constexpr (M::has_effects) {
    if (run_.effects.stress) run_.count_collision(event.between, event.outcome.impulse, tally_);
  }
}

template <Search S, Model M>
NeedleAt EventProcessor<S, M>::needle_at(Needle i) const {
  const kernels::BodyState present = model_.present(i, now());
  return {.needle = i,
          .id = gas_.ids[i],
          .record = gas_.records[i],
          .body = model_.body(i),
          .now = now(),
          .centre = present.r,
          .director = present.u,
          .velocity = gas_.shear ? present.v - gas_.flow_at(present.r) : present.v,
          .angular_velocity = present.w};
}

template <Search S, Model M>
void EventProcessor<S, M>::happen(const Event& event) {
  const Needle i = event.owner;
  count_at_instant(i, i);
  const NeedleAt at = needle_at(i);
  // Sources see needles from where they are in the flow.
  const Vec3d flow = gas_.flow_at(at.centre);
  if (rollback_log) rollback_log->replaced(i, gas_);
  columns_before_.clear();
  gas_.columns.append(i, columns_before_);
  gas_.columns.count_change(i);
  EventSource& source = *run_.sources[event.source];
  const SourceOutcome outcome = source.happen(gas_, at, event.side);
  const std::optional<double> cut = pair_events_.source_acts(i, now(), source.kind());
  Happening happening;
  happening.kind = source.kind();
  happening.source = static_cast<std::uint8_t>(event.source + 1);
  Collision& report = happening.event;
  set_time(report);
  report.first = gas_.ids[i].value;
  report.second = outcome.object;
  report.arm_first = outcome.arm;
  report.normal_velocity = outcome.normal_velocity;
  report.impulse = {outcome.impulse.x, outcome.impulse.y, outcome.impulse.z};
  report.energy_change = outcome.energy_change;
  report.contact_time_rule = outcome.contact_time_rule;
  if (outcome.changes_motion) {
    try {
      replace_record(i, [&] {
        return model_.renew(i, now(),
                            {at.centre, gas_.shear ? outcome.velocity + flow : outcome.velocity,
                             at.director, outcome.angular_velocity});
      });
    } catch (const InvalidStateError&) {
      predictor_.put_back();
      gas_.columns.put_back(i, columns_before_.data());
      --tally_.at_instant;
      throw;
    }
    if (cut) tally_.sliding.cut(*cut);
    tally_.hash.add(happening);
  }
  const Quanta quanta =
      outcome.changes_motion ? run_.energy.in_quanta(outcome.energy_change) : Quanta();
  tally_.energy += quanta;
  const Quanta growth =
      outcome.growth_work != 0 ? run_.energy.in_quanta(outcome.growth_work) : Quanta();
  tally_.growth += growth;
  tally_.count_source(event.source, quanta - growth, run_.sources.size());
  if (source.objects() > 0) {
    tally_.count_object(run_.first_object[event.source] + outcome.object,
                        {quanta - growth, outcome.normal_impulse, outcome.work, outcome.impulse},
                        run_.objects);
  }
  schedule(i, place(i));
  if (run_.listeners.any()) run_.listeners.report(gas_, happening, i, no_needle, reports);
}

// The earliest event of the sources, if it is before `best`.
template <Search S, Model M>
void EventProcessor<S, M>::consider_sources(Needle i, Event& best) const {
  for (std::size_t n = 0; n < run_.sources.size(); ++n) {
    const SourceEvent next = run_.sources[n]->next(gas_, i, now(), best.time);
    if (next.time == Time::never()) continue;
    Event event;
    event.kind = EventKind::source;
    event.owner = i;
    event.lower_id = event.higher_id = gas_.ids[i];
    event.time = next.time;
    event.side = next.detail;
    event.source = static_cast<std::uint8_t>(n);
    event.resolvable = next.resolvable;
    if (event < best) best = event;
  }
}

template <Search S, Model M>
void EventProcessor<S, M>::schedule(Needle i, Time placed_until, const JustHit& just_hit) {
  if (rollback_log) rollback_log->scheduled(i, gas_.records[i]);
  // Needed after the search, which takes longer than memory does.
  const CellIndex cell = cell_of(i);
  calendar_.prefetch(i, cell);
  const Event next = next_event(i, placed_until, just_hit);
  search_.set_next_event(i, next.time);
  calendar_.set(next, cell);
}

template <Search S, Model M>
[[gnu::always_inline]] inline Event EventProcessor<S, M>::next_event(Needle i, Time placed_until,
                                                                     const JustHit& just_hit) {
  ++tally_.counters.searches;
  const Time time = now();
  Event best;
  best.owner = i;
  best.lower_id = best.higher_id = gas_.ids[i];
  best.time = std::min(
      {placed_until, gas_.records[i].renewal, gas_.clock.add(time, run_.windows.search_span())});
  if constexpr (M::has_effects) {
    if (run_.kicks || run_.growing) best.time = std::min(best.time, run_.search_until());
    consider_sources(i, best);
  }
  search_.find({i, just_hit, time, gas_.clock.difference(best.time, time)}, model_,
               [&](Needle j, const Shift& shift, double from) {
                 consider(i, j, shift, from, best);
                 return gas_.clock.difference(best.time, time);
               });
  return best;
}

// Looks for a contact of i with candidate j that is earlier than `best`, and replaces `best` by
// it. The contact does not come before the time `from` after now.
template <Search S, Model M>
void EventProcessor<S, M>::consider(Needle i, Needle j, const Shift& shift, double from,
                                    Event& best) {
  const Record& mine = gas_.records[i];
  const Record& other = gas_.records[j];
  if constexpr (M::has_effects) {
    if (run_.effects.passing && !gas_.composition.meets(mine.species, other.species)) return;
  }
  // If j has an event before the contact, j searches again then, or earlier, and finds the contact
  // if it still takes place. The renewal counts on its own: not every search knows the next event,
  // and it is that of the present record only once j has searched.
  const Time until = std::min({best.time, other.renewal, search_.next_event(j)});
  Event event;
  event.kind = EventKind::contact;
  event.owner = i;
  event.partner = j;
  event.partner_serial = other.serial;
  event.owner_is_lower = gas_.ids[i] < gas_.ids[j];
  event.shift = event.owner_is_lower ? shift : -shift;
  const Needle a = event.lower(), b = event.higher();
  event.lower_id = gas_.ids[a];
  event.higher_id = gas_.ids[b];
  const kernels::Contact contact = predictor_.predict(a, b, event.shift, from, until);
  if constexpr (M::Law::never_overlap) {
    if (contact.overlap) report_overlap(a, b, event.shift);
  }
  if (!contact.found) return;
  event.time = gas_.clock.add(Gas::start_of(mine, other), contact.elapsed.hi);
  event.side = static_cast<std::int8_t>(contact.side);
  event.resolvable = !contact.unresolvable;
  if (event.time < now()) {
    throw UnfinishedEventError("needles " + std::to_string(event.lower_id.value) + " and " +
                                   std::to_string(event.higher_id.value) + ": a contact at time " +
                                   std::to_string(gas_.clock.since_start(event.time)) +
                                   " was missed; this is a defect of the program",
                               {{event.lower_id.value, event.higher_id.value}});
  }
  if (event < best) best = event;
}

// Three needles or more can collapse by hitting each other in turn. The time then no longer
// advances, and more collisions happen at one instant than is possible otherwise. The limit is
// high, because rough needles have been observed to separate after more than four thousand
// collisions at one instant.
template <Search S, Model M>
void EventProcessor<S, M>::count_at_instant(Needle a, Needle b) {
  if (now() != tally_.instant) tally_.at_instant = 0;
  tally_.instant = now();
  if (++tally_.at_instant <= 10000 + 2 * gas_.size()) return;
  throw InvalidStateError(
      message_of(GroupCollapse{gas_.ids[a], gas_.ids[b], gas_.clock.since_start(now()),
                               tally_.at_instant, run_.effects.contact_time, run_.effects.sliding}),
      {{gas_.ids[a].value, gas_.ids[b].value}});
}

// Rods that overlap have passed through their contact, which is never so.
template <Search S, Model M>
void EventProcessor<S, M>::report_overlap(Needle a, Needle b, const Shift& shift) const {
  const Record &first = gas_.records[a], &second = gas_.records[b];
  const auto pair = model_.pair(a, first, b, second, shift);
  throw UnfinishedEventError(
      fmt::format("rods {} and {} overlap by {:.3g} at time {:.17g}: a contact was missed; this is "
                  "a defect of the program",
                  gas_.ids[a].value, gas_.ids[b].value, -model_.contact().gap(pair, DoubleDouble()),
                  gas_.clock.since_start(Gas::start_of(first, second))),
      {{gas_.ids[a].value, gas_.ids[b].value}});
}

template <Search S, Model M>
void EventProcessor<S, M>::refuse(const Event& event) {
  if (event.kind != EventKind::source) report_collapse(event);
  set_now(event.time);
  const std::uint32_t id = gas_.ids[event.owner].value;
  throw InvalidStateError(
      run_.sources[event.source]->message(gas_, needle_at(event.owner), event.side), {{id, id}});
}

template <Search S, Model M>
void EventProcessor<S, M>::report_collapse(const Event& event) const {
  const Needle a = event.lower(), b = event.higher();
  const Record& first = gas_.records[a];
  const Record& second = gas_.records[b];
  const auto pair = model_.pair(a, first, b, second, event.shift);
  const Time start = Gas::start_of(first, second);
  const DoubleDouble elapsed = gas_.clock.exact_difference(event.time, start);
  throw InvalidStateError(
      message_of(PairCollapse{.first = event.lower_id,
                              .second = event.higher_id,
                              .time = gas_.clock.since_start(event.time),
                              .gap = model_.contact().gap(pair, elapsed) /
                                     model_.contact().geometry(pair, elapsed).sin_angle,
                              .after = gas_.clock.difference(event.time, start),
                              .root_tolerance = model_.accuracy().root_tolerance,
                              .epsilon = model_.restitution(first, second).epsilon,
                              .contact_time = model_.effects().contact_time}),
      {{event.lower_id.value, event.higher_id.value}});
}

}  // namespace needlework
