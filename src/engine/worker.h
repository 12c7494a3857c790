// Makes events happen: changes the records, and predicts anew for the needles concerned.
//
// Every needle has one event in the calendar: the earliest contact that its own last search found,
// or the horizon at which that search was cut. A contact lies only with the needle that predicted
// it; when its partner has been changed meanwhile, it is stale, and its owner searches again at
// that time. So no cut search is ever forgotten, whatever happens to the contact that cut it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "needlework/error.h"
#include "src/engine/run.h"
#include "src/engine/undo_log.h"
#include "src/memory/prefetch.h"

namespace needlework {

/// Effects inside a collision, chosen at compile time.
struct Effects {
  bool rough = false;         ///< beta != -1
  bool contact_time = false;  ///< the t_c rule
};

/// One thread's part in a run. Search, queue and tally are its own; the run is everybody's.
template <class Search, class Queue, Effects effects>
class Worker {
 public:
  Worker(Run& run, Search& search, Queue& queue, Tally& tally)
      : run_(run), gas_(run.gas), search_(search), queue_(queue), tally_(tally) {}

  /// Whether the partner of this contact has a new record since it was predicted.
  bool is_stale(const Event& event) const {
    return event.is_contact() && gas_.records[event.partner].serial != event.partner_serial;
  }
  /// Makes the event happen, at `now`.
  void happen(const Event& event, bool stale);
  /// Searches contacts of needle i from now on and enters its next event.
  [[gnu::noinline]] void schedule(Needle i, Time placed_until);
  /// Puts an event into the queue; one by place is told where its owner is.
  void enter(const Event& event) {
    if constexpr (requires { queue_.set(event, search_.cell_index(event.owner)); }) {
      queue_.set(event, search_.cell_index(event.owner));
    } else {
      queue_.set(event);
    }
  }
  /// Brings what an event of this needle will read near.
  void bring_near(Needle i) const {
    prefetch(&gas_.records[i]);
    if constexpr (requires { search_.bring_near(i); }) search_.bring_near(i);
  }
  /// What is known of the last event no longer holds: needles have other places in storage, or
  /// records have been put back.
  void forget() {
    last_shared_ = {};
    replaced_count_ = 0;
  }

  Time now;
  UndoLog* undo = nullptr;                    ///< where to note what is replaced, if anywhere
  std::vector<Collision>* reports = nullptr;  ///< where to put collisions in place of the callback
#ifndef NDEBUG
  /// Whether this event has read a record from later than itself, of a needle within reach then.
  bool read_ahead = false;
#endif

 private:
  // A record that the event at hand has replaced, and the boxes by which its centre was wrapped.
  struct Replaced {
    Needle needle = no_needle;
    Record record;
    Shift wraps{};
  };

  // What was predicted of two needles just after their collision.
  struct Shared {
    Needle a = no_needle, b = no_needle;
    std::uint32_t serial_a = 0, serial_b = 0;
    Shift shift{};
    Time until;
    kernels::Contact contact;
  };

  void consider(Needle i, Needle j, const Shift& shift, double from, double to, Event& best);
  kernels::Contact predict(Needle a, Needle b, const Shift& shift, double from, Time until);
  kernels::Contact first_contact_of(const kernels::Pair& pair, double from, double to);
  void settle_touch(Needle a, Needle b, const Shift& shift);
  [[gnu::noinline]] Shift replace_record(Needle i, const Vec3d& director, const Vec3d& v,
                                         const Vec3d& w);
  void horizon(Needle i);
  // Functions apart, so that a test can read what code an effect has.
  [[gnu::noinline]] void collide(const Event& event);
  void count_at_instant(Needle a, Needle b);
  [[noreturn]] void report_collapse(const Event& event) const;

  Run& run_;
  Gas& gas_;
  Search& search_;
  Queue& queue_;
  Tally& tally_;
  Shared last_shared_;
  Replaced replaced_[2];
  int replaced_count_ = 0;
};

template <class Search, class Queue, Effects effects>
void Worker<Search, Queue, effects>::happen(const Event& event, bool stale) {
  if (!event.resolvable && !stale) report_collapse(event);
  ++tally_.counters.events;
  now = event.time;
  replaced_count_ = 0;
  if (!event.is_contact()) {
    horizon(event.owner);
  } else if (stale) {
    ++tally_.counters.stale;
    schedule(event.owner, search_.place(event.owner, now));
  } else {
    collide(event);
  }
}

// A horizon is the end of the record's precision, of the search's candidates, or of the span ahead.
template <class Search, class Queue, Effects effects>
void Worker<Search, Queue, effects>::horizon(Needle i) {
  const Record& record = gas_.records[i];
  if (record.renewal <= now) {
    ++tally_.counters.renewals;
    const double elapsed = gas_.clock.difference(now, record.time);
    replace_record(i, director_after(record.flight, elapsed), record.flight.v, record.flight.w);
  }
  schedule(i, search_.place(i, now));
}

template <class Search, class Queue, Effects effects>
Shift Worker<Search, Queue, effects>::replace_record(Needle i, const Vec3d& director,
                                                     const Vec3d& v, const Vec3d& w) {
  Replaced& old = replaced_[replaced_count_++];
  old.needle = i;
  old.record = gas_.records[i];
  if (undo) {
    undo->replaced(i, old.record, gas_.images[i],
                   effects.contact_time ? run_.last_collision[i] : Time{});
  }
  old.wraps = renew_record(gas_, i, now, director, v, w);
  return old.wraps;
}

template <class Search, class Queue, Effects effects>
void Worker<Search, Queue, effects>::collide(const Event& event) {
  const Needle a = event.lower(), b = event.higher();
  count_at_instant(a, b);
  const Record& first = gas_.records[a];
  const Record& second = gas_.records[b];
  const kernels::Pair pair = make_pair(gas_, a, first, b, second, event.shift);
  const DoubleDouble elapsed = gas_.clock.exact_difference(now, Gas::start_of(first, second));
  const kernels::ContactGeometry contact = contact_geometry(pair, elapsed);

  bool by_contact_time = false;
  if constexpr (effects.contact_time) {
    by_contact_time = gas_.clock.difference(now, run_.last_collision[a]) < run_.contact_time ||
                      gas_.clock.difference(now, run_.last_collision[b]) < run_.contact_time;
  }
  const auto outcome = [&] {
    const kernels::Flight &x = first.flight, &y = second.flight;
    if (by_contact_time) {
      return needlework::collide<true>(x, y, contact, event.side, gas_.k, Restitution{});
    }
    return needlework::collide<!effects.rough>(x, y, contact, event.side, gas_.k, run_.restitution);
  };
  const Impact impact = outcome();

  Collision report;
  report.epoch = now.epoch;
  report.offset = now.offset;
  report.time = gas_.clock.since_start(now);
  report.first = gas_.ids[a];
  report.second = gas_.ids[b];
  report.shift = event.shift;
  report.arm_first = contact.arm_first;
  report.arm_second = contact.arm_second;
  report.sin_angle = contact.sin_angle;
  report.normal_velocity = impact.normal_velocity;
  report.impulse = {impact.impulse.x, impact.impulse.y, impact.impulse.z};
  report.energy_change = impact.energy_change;
  report.contact_time_rule = by_contact_time;

  const Shift wraps_a = replace_record(a, contact.u_first, impact.v_first, impact.w_first);
  const Shift wraps_b = replace_record(b, contact.u_second, impact.v_second, impact.w_second);
  if constexpr (effects.contact_time) run_.last_collision[a] = run_.last_collision[b] = now;
  const Shift shift = event.shift + wraps_b - wraps_a;
  const kernels::Touch touch{.touching = true, .collided = true, .side = event.side, .gap = 0};
  gas_.records[a].touches.push_back({b, gas_.records[b].serial, shift, touch});
  gas_.records[b].touches.push_back({a, gas_.records[a].serial, -shift, touch});

  tally_.energy += run_.in_quanta(impact.energy_change);
  ++tally_.collisions;
  tally_.tc_collisions += by_contact_time;
  tally_.hash.add(report);
  const Time placed_a = search_.place(a, now), placed_b = search_.place(b, now);
  schedule(a, placed_a);
  schedule(b, placed_b);
  if (reports || run_.callback) run_.tell(report, a, b, reports);
}

template <class Search, class Queue, Effects effects>
void Worker<Search, Queue, effects>::schedule(Needle i, Time placed_until) {
  ++tally_.counters.searches;
  if (undo) undo->scheduled(i);
  Event best;
  best.owner = i;
  best.lower_id = best.higher_id = gas_.ids[i];
  best.time =
      std::min({placed_until, gas_.records[i].renewal, gas_.clock.add(now, run_.search_span)});
  search_.find(i, now, gas_.clock.difference(best.time, now),
               [&](Needle j, const Shift& shift, double from, double to) {
                 consider(i, j, shift, from, to, best);
                 return gas_.clock.difference(best.time, now);
               });
  enter(best);
}

// Looks for a contact of i with this candidate before `best`, and makes it the best. It can only be
// between the times `from` and `to` from now.
template <class Search, class Queue, Effects effects>
void Worker<Search, Queue, effects>::consider(Needle i, Needle j, const Shift& shift, double from,
                                              double to, Event& best) {
  const Record& mine = gas_.records[i];
  const Record& other = gas_.records[j];
  // Beyond the renewal of j its own event takes over.
  const Time until = std::min({best.time, other.renewal, gas_.clock.add(now, to)});
  Event event;
  event.owner = i;
  event.partner = j;
  event.partner_serial = other.serial;
  event.owner_is_lower = gas_.ids[i] < gas_.ids[j];
  event.shift = event.owner_is_lower ? shift : -shift;
  const Needle a = event.lower(), b = event.higher();
  event.lower_id = gas_.ids[a];
  event.higher_id = gas_.ids[b];
  const kernels::Contact contact = predict(a, b, event.shift, from, until);
  if (!contact.found) return;
  event.time = gas_.clock.add(Gas::start_of(mine, other), contact.elapsed.hi);
  event.side = static_cast<std::int8_t>(contact.side);
  event.resolvable = !contact.unresolvable;
  if (event.time < now) {
    throw InvalidStateError("needles " + std::to_string(event.lower_id) + " and " +
                            std::to_string(event.higher_id) + ": a contact at time " +
                            std::to_string(gas_.clock.since_start(event.time)) +
                            " was missed; this is a defect of the program");
  }
  if (event < best) best = event;
}

template <class Search, class Queue, Effects effects>
kernels::Contact Worker<Search, Queue, effects>::predict(Needle a, Needle b, const Shift& shift,
                                                         double from_now, Time until) {
  ++tally_.counters.predicted;
  const Record& first = gas_.records[a];
  const Record& second = gas_.records[b];
  const Time start = Gas::start_of(first, second);
  // With several threads a record may be from later than now; till then the needles do not meet.
  if (until < start) return {};
  // Rounded outwards; the times themselves are compared exactly.
  double from = std::max(0.0, (gas_.clock.difference(now, start) + from_now) * (1 - 0x1p-50));
  // A little later may be the same time on the clock, where the ids decide.
  const double to = (gas_.clock.difference(until, start) + gas_.clock.resolution()) * (1 + 0x1p-50);
  kernels::Pair pair = make_pair(gas_, a, first, b, second, shift);
#ifndef NDEBUG
  if (start > now) {
    const Vec3d apart = (centre_after(first.flight, pair.elapsed_first.hi) -
                         centre_after(second.flight, pair.elapsed_second.hi)) -
                        to_double(pair.shift);
    if (dot(apart, apart) <= 1) read_ahead = true;
  }
#endif
  // Both partners of a collision search the pair, with records made now.
  const bool shared = pair.touch.collided && first.time == second.time;
  const Shared& last = last_shared_;
  if (shared && last.a == a && last.b == b && same(last.shift, shift) &&
      last.serial_a == first.serial && last.serial_b == second.serial) {
    if (last.contact.found || until <= last.until) return last.contact;
    from = gas_.clock.difference(last.until, start) * (1 - 0x1p-50);
  }
  kernels::Contact contact = first_contact_of(pair, from, to);
  if (contact.side_unknown) {
    settle_touch(a, b, shift);
    pair = make_pair(gas_, a, first, b, second, shift);
    contact = first_contact_of(pair, from, to);
  }
  // A return that the clock cannot tell from the collision before.
  if (contact.found && pair.touch.collided && contact.elapsed.hi < 64 * gas_.clock.resolution()) {
    contact.unresolvable = true;
  }
  if (shared) last_shared_ = {a, b, first.serial, second.serial, shift, until, contact};
  return contact;
}

template <class Search, class Queue, Effects effects>
kernels::Contact Worker<Search, Queue, effects>::first_contact_of(const kernels::Pair& pair,
                                                                  double from, double to) {
  kernels::SearchCounters spent;
  const kernels::Contact contact = first_contact(pair, from, to, spent, run_.accuracy);
  tally_.counters.evaluated += spent.evaluated;
  tally_.counters.escalated += spent.escalated;
  return contact;
}

// A record has just been made anew so near to touching another needle that rounding it may have
// moved it to the other side. The gap is continued from the records before.
template <class Search, class Queue, Effects effects>
void Worker<Search, Queue, effects>::settle_touch(Needle a, Needle b, const Shift& shift) {
  if (std::max(gas_.records[a].time, gas_.records[b].time) > now) {
    throw InvalidStateError("needles touch at an event that another thread has done before");
  }
  ++tally_.counters.touches;
  const Record* first = &gas_.records[a];
  const Record* second = &gas_.records[b];
  Shift old_shift = shift;
  for (int n = 0; n < replaced_count_; ++n) {
    const Replaced& old = replaced_[n];
    if (old.needle == a) {
      first = &old.record;
      old_shift = old_shift + old.wraps;
    } else if (old.needle == b) {
      second = &old.record;
      old_shift = old_shift - old.wraps;
    }
  }
  const kernels::Pair before = make_pair(gas_, a, *first, b, *second, old_shift);
  const Time start = Gas::start_of(*first, *second);
  const double elapsed = gas_.clock.difference(now, start);
  kernels::Touch touch{.touching = true, .collided = false, .side = 0, .gap = 0};
  const double tick = gas_.clock.resolution();
  // By so much of it, at most, the time told for a contact may be off.
  const double off = std::max(0x1p-38, 2 * run_.accuracy.root_tolerance);
  const kernels::Contact due = first_contact_of(
      before, std::max(0.0, elapsed - tick) * (1 - 0x1p-50), (elapsed + tick) * (1 + off));
  const double gap = gap_at(before, gas_.clock.exact_difference(now, start));
  const int side = gap > 0 ? 1 : gap < 0 ? -1 : 0;
  // A contact that is due now and has not happened yet; or is due so soon that the time told for it
  // is later than that at which f vanishes.
  if (due.found && (gas_.clock.add(start, due.elapsed.hi) <= now || side != due.side)) {
    touch.side = due.side;
  } else {
    touch.gap = gap;
    touch.side = side;
    // On the contact itself: one just had, at this very instant, or a touch.
    const bool just_had = before.touch.touching && elapsed == 0;
    if (touch.side == 0) touch.side = just_had ? before.touch.side : side_after(before);
    // Centre on centre, turning in one place, they had none.
    if (touch.side == 0) {
      touch.side = side_after(make_pair(gas_, a, gas_.records[a], b, gas_.records[b], shift));
    }
  }
  Record &mine = gas_.records[a], &other = gas_.records[b];
  if (mine.time >= other.time) {
    mine.touches.push_back({b, other.serial, shift, touch});
  } else {
    other.touches.push_back({a, mine.serial, -shift, touch});
  }
}

// Three needles or more can collapse too, by hitting each other in turn. When that has come to
// where the clock stands still, more collisions happen at one instant than needles could have
// there. Rough needles have been seen to go on after more than four
// thousand.
template <class Search, class Queue, Effects effects>
void Worker<Search, Queue, effects>::count_at_instant(Needle a, Needle b) {
  if (now != tally_.instant) tally_.at_instant = 0;
  tally_.instant = now;
  if (++tally_.at_instant <= 10000 + 2 * gas_.size()) return;
  throw InvalidStateError("needles " + std::to_string(gas_.ids[a]) + " and " +
                          std::to_string(gas_.ids[b]) + " and others collapse at time " +
                          std::to_string(gas_.clock.since_start(now)) + ": " +
                          std::to_string(tally_.at_instant) +
                          " collisions at one instant; set collisions.tc_relative, to 1e-3 say");
}

template <class Search, class Queue, Effects effects>
void Worker<Search, Queue, effects>::report_collapse(const Event& event) const {
  const Needle a = event.lower(), b = event.higher();
  const Record& first = gas_.records[a];
  const Record& second = gas_.records[b];
  const kernels::Pair pair = make_pair(gas_, a, first, b, second, event.shift);
  const Time start = Gas::start_of(first, second);
  const kernels::ContactGeometry contact =
      contact_geometry(pair, gas_.clock.exact_difference(event.time, start));
  const double gap =
      gap_at(pair, gas_.clock.exact_difference(event.time, start)) / contact.sin_angle;
  const std::string advice =
      run_.accuracy.root_tolerance > 0x1p-30
          ? "engine.root_tolerance is so coarse that needles may stand beyond their contact"
      : run_.restitution.epsilon == 0
          ? "with collisions.epsilon = 0 there is no rebound, and no contact time can help"
      : effects.contact_time
          ? "a longer contact time helps, unless they meet by rounding alone, as in one plane"
          : "set collisions.tc_relative, to 1e-3 say, so that they slide along each other";
  char numbers[160];
  std::snprintf(numbers, sizeof numbers, " at time %.17g, gap %.3g, back after %.3g",
                gas_.clock.since_start(event.time), gap, gas_.clock.difference(event.time, start));
  throw InvalidStateError("collapse of needles " + std::to_string(gas_.ids[a]) + " and " +
                          std::to_string(gas_.ids[b]) + numbers +
                          ": their next bounce is below what double resolves; " + advice);
}

}  // namespace needlework
