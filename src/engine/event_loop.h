// The event loop: takes the earliest event, makes it happen, and predicts anew for those it
// touched.
//
// Every needle has one event in the calendar: the earliest contact that its own last search found,
// or the horizon at which that search was cut. A contact lies only with the needle that predicted
// it; when its partner has been changed meanwhile, it is stale, and its owner searches again at
// that time. So no cut search is ever forgotten, whatever happens to the contact that cut it.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "src/engine/run.h"
#include "src/engine/space_order.h"
#include "src/error.h"
#include "src/prefetch.h"
#include "src/search/setup.h"

namespace needlework {

/// Effects inside a collision, chosen at compile time.
struct Effects {
  bool rough = false;         ///< beta != -1
  bool contact_time = false;  ///< the t_c rule
};

template <class Search, class Calendar, Effects effects>
class EventLoop final : public Run {
 public:
  EventLoop(const Scene& scene, Gas initial, const SearchSetup& setup);

  Stop advance(const Scene::Until& until) override;
  const char* search_name() const override { return Search::name; }
  const char* queue_name() const override { return Calendar::name; }

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

  void bring_near(Needle i) const;
  void sort_storage();
  void schedule(Needle i, Time placed_until);
  void consider(Needle i, Needle j, const Shift& shift, double from, double to, Event& best);
  kernels::Contact predict(Needle a, Needle b, const Shift& shift, double from, Time until);
  void settle_touch(Needle a, Needle b, const Shift& shift);
  Shift replace_record(Needle i, const Vec3d& director, const Vec3d& v, const Vec3d& w);
  void happen(const Event& event);
  void horizon(Needle i);
  void collide(const Event& event);
  void count_at_instant(Needle a, Needle b);
  [[noreturn]] void report_collapse(const Event& event) const;

  Search search_;
  Calendar calendar_;
  Time instant_;  ///< of the last collision
  std::uint64_t collisions_at_instant_ = 0;
  std::vector<Time> last_collision_;  ///< for the t_c rule; renewals do not count
  std::uint64_t sorted_at_ = 0;       ///< crossings when the needles were last sorted
  Shared last_shared_;
  Replaced replaced_[2];
  int replaced_count_ = 0;
  kernels::SearchCounters kernel_counters_;
};

template <class Search, class Calendar, Effects effects>
EventLoop<Search, Calendar, effects>::EventLoop(const Scene& scene, Gas initial,
                                                const SearchSetup& setup)
    : Run(scene, std::move(initial)),
      search_(gas, counters, setup),
      calendar_(gas.size(), gas.clock) {
  if constexpr (effects.contact_time) {
    last_collision_.assign(gas.size(), Time{-(std::int64_t{1} << 62), 0});
  }
  const Needle count = static_cast<Needle>(gas.size());
  std::vector<Time> placed_until(count);
  for (Needle i = 0; i < count; ++i) placed_until[i] = search_.place(i, now);
  for (Needle i = 0; i < count; ++i) schedule(i, placed_until[i]);
}

template <class Search, class Calendar, Effects effects>
Stop EventLoop<Search, Calendar, effects>::advance(const Scene::Until& until) {
  using WallClock = std::chrono::steady_clock;
  const auto wall_start = WallClock::now();
  interrupted = false;
  const bool timed = until.time.has_value();
  const Time target = timed ? gas.clock.add({}, std::max(0.0, *until.time)) : Time::never();
  if (target < now) return Stop::time;
  if (!timed && !until.collisions_per_needle && !until.energy_ratio && !until.wall_s) {
    throw InputError("until: expected at least one end condition");
  }
  if (nothing_can_happen()) {
    if (!timed) return Stop::nothing_can_happen;
    now = target;
    return Stop::time;
  }
  const double most_collisions =
      until.collisions_per_needle
          ? *until.collisions_per_needle * static_cast<double>(gas.size()) / 2
          : std::numeric_limits<double>::infinity();
  const double least_energy = until.energy_ratio ? *until.energy_ratio * initial_energy_ : -1;
  const auto reached = [&] { return static_cast<double>(collisions_) >= most_collisions; };

  for (;;) {
    if (reached()) return Stop::collisions;
    if (energy_ <= least_energy) return Stop::energy;
    if (counters.events % 256 == 0) {
      if (interrupted) return Stop::interrupted;
      if (until.wall_s &&
          std::chrono::duration<double>(WallClock::now() - wall_start).count() >= *until.wall_s) {
        return Stop::wall_time;
      }
    }
    const Event event = calendar_.top();
    bring_near(event.owner);
    if constexpr (requires { calendar_.soon(); }) bring_near(calendar_.soon());
    if (window_end_ <= std::min(event.time, target)) {
      now = window_end_;
      open_window();
      if (counters.crossings - sorted_at_ > 2 * gas.size()) sort_storage();
      continue;
    }
    if (event.time > target) {
      now = target;
      return Stop::time;
    }
    if (!event.resolvable &&
        calendar_.of(event.owner).partner_serial == gas.records[event.partner].serial) {
      report_collapse(event);
    }
    now = event.time;
    happen(event);
    ++counters.events;
    counters.evaluated = kernel_counters_.evaluated;
    counters.escalated = kernel_counters_.escalated;
  }
}

// What an event of this needle will read.
template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::bring_near(Needle i) const {
  prefetch(&gas.records[i]);
  if constexpr (requires { search_.bring_near(i); }) search_.bring_near(i);
}

// Stores neighbours in space next to each other again, once many have moved on.
template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::sort_storage() {
  ++counters.sorts;
  sorted_at_ = counters.crossings;
  const std::vector<Needle> order = order_in_space(gas, now), ranks = ranks_of(order);
  reorder(gas, order);
  search_.renumber(ranks);
  if constexpr (effects.contact_time) permute(last_collision_, order);
  last_shared_ = {};
  std::vector<Event> events;
  events.reserve(gas.size());
  for (const Needle i : order) {
    Event& event = events.emplace_back(calendar_.of(i));
    event.owner = ranks[event.owner];
    if (event.is_contact()) event.partner = ranks[event.partner];
  }
  calendar_ = Calendar(0, gas.clock);  // frees its memory
  calendar_ = Calendar(gas.size(), gas.clock);
  for (const Event& event : events) calendar_.set(event);
}

template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::happen(const Event& event) {
  replaced_count_ = 0;
  if (!event.is_contact()) {
    horizon(event.owner);
  } else if (gas.records[event.partner].serial != event.partner_serial) {
    ++counters.stale;
    schedule(event.owner, search_.place(event.owner, now));
  } else {
    collide(event);
  }
}

// A horizon is the end of the record's precision, of the search's candidates, or of the span ahead.
template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::horizon(Needle i) {
  const Record& record = gas.records[i];
  if (record.renewal <= now) {
    ++counters.renewals;
    const double elapsed = gas.clock.difference(now, record.time);
    replace_record(i, director_after(record.flight, elapsed), record.flight.v, record.flight.w);
  }
  schedule(i, search_.place(i, now));
}

template <class Search, class Calendar, Effects effects>
Shift EventLoop<Search, Calendar, effects>::replace_record(Needle i, const Vec3d& director,
                                                           const Vec3d& v, const Vec3d& w) {
  Replaced& old = replaced_[replaced_count_++];
  old.needle = i;
  old.record = gas.records[i];
  old.wraps = renew_record(gas, i, now, director, v, w);
  return old.wraps;
}

template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::collide(const Event& event) {
  const Needle a = event.lower(), b = event.higher();
  count_at_instant(a, b);
  const Record& first = gas.records[a];
  const Record& second = gas.records[b];
  const kernels::Pair pair = make_pair(gas, a, first, b, second, event.shift);
  const DoubleDouble elapsed = gas.clock.exact_difference(now, Gas::start_of(first, second));
  const kernels::ContactGeometry contact = contact_geometry(pair, elapsed);

  bool by_contact_time = false;
  if constexpr (effects.contact_time) {
    by_contact_time = gas.clock.difference(now, last_collision_[a]) < contact_time_ ||
                      gas.clock.difference(now, last_collision_[b]) < contact_time_;
    last_collision_[a] = last_collision_[b] = now;
  }
  const auto outcome = [&] {
    const kernels::Flight &x = first.flight, &y = second.flight;
    if (by_contact_time) {
      return needlework::collide<true>(x, y, contact, event.side, gas.k, Restitution{});
    }
    return needlework::collide<!effects.rough>(x, y, contact, event.side, gas.k, restitution);
  };
  const Impact impact = outcome();

  Collision report;
  report.epoch = now.epoch;
  report.offset = now.offset;
  report.time = gas.clock.since_start(now);
  report.first = gas.ids[a];
  report.second = gas.ids[b];
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
  const Shift shift = event.shift + wraps_b - wraps_a;
  const kernels::Touch touch{.touching = true, .collided = true, .side = event.side, .gap = 0};
  gas.records[a].touches.push_back({b, shift, touch});
  gas.records[b].touches.push_back({a, -shift, touch});

  energy_ += impact.energy_change;
  ++collisions_;
  tc_collisions_ += by_contact_time;
  hash.add(report);
  const Time placed_a = search_.place(a, now), placed_b = search_.place(b, now);
  schedule(a, placed_a);
  schedule(b, placed_b);
  if (callback) tell(report, a, b);
}

// Searches contacts of needle i from now on and enters its next event.
template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::schedule(Needle i, Time placed_until) {
  ++counters.searches;
  Event best;
  best.owner = i;
  best.lower_id = best.higher_id = gas.ids[i];
  best.time = std::min({placed_until, gas.records[i].renewal, gas.clock.add(now, search_span_)});
  search_.find(i, now, gas.clock.difference(best.time, now),
               [&](Needle j, const Shift& shift, double from, double to) {
                 consider(i, j, shift, from, to, best);
                 return gas.clock.difference(best.time, now);
               });
  calendar_.set(best);
}

// Looks for a contact of i with this candidate before `best`, and makes it the best. It can only be
// between the times `from` and `to` from now.
template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::consider(Needle i, Needle j, const Shift& shift,
                                                    double from, double to, Event& best) {
  const Record& mine = gas.records[i];
  const Record& other = gas.records[j];
  // Beyond the renewal of j its own event takes over.
  const Time until = std::min({best.time, other.renewal, gas.clock.add(now, to)});
  Event event;
  event.owner = i;
  event.partner = j;
  event.partner_serial = other.serial;
  event.owner_is_lower = gas.ids[i] < gas.ids[j];
  event.shift = event.owner_is_lower ? shift : -shift;
  const Needle a = event.lower(), b = event.higher();
  event.lower_id = gas.ids[a];
  event.higher_id = gas.ids[b];
  const kernels::Contact contact = predict(a, b, event.shift, from, until);
  if (!contact.found) return;
  event.time = gas.clock.add(Gas::start_of(mine, other), contact.elapsed.hi);
  event.side = static_cast<std::int8_t>(contact.side);
  event.resolvable = !contact.unresolvable;
  if (event.time < now) {
    throw InvalidStateError("needles " + std::to_string(event.lower_id) + " and " +
                            std::to_string(event.higher_id) + ": a contact at time " +
                            std::to_string(gas.clock.since_start(event.time)) +
                            " was missed; this is a defect of the program");
  }
  if (event < best) best = event;
}

template <class Search, class Calendar, Effects effects>
kernels::Contact EventLoop<Search, Calendar, effects>::predict(Needle a, Needle b,
                                                               const Shift& shift, double from_now,
                                                               Time until) {
  ++counters.predicted;
  const Record& first = gas.records[a];
  const Record& second = gas.records[b];
  const Time start = Gas::start_of(first, second);
  // Rounded outwards; the times themselves are compared exactly.
  double from = (gas.clock.difference(now, start) + from_now) * (1 - 0x1p-50);
  const double to = gas.clock.difference(until, start) * (1 + 0x1p-50);
  kernels::Pair pair = make_pair(gas, a, first, b, second, shift);
  // Both partners of a collision search the pair, with records made now.
  const bool shared = pair.touch.collided && first.time == second.time;
  const Shared& last = last_shared_;
  if (shared && last.a == a && last.b == b && same(last.shift, shift) &&
      last.serial_a == first.serial && last.serial_b == second.serial) {
    if (last.contact.found || until <= last.until) return last.contact;
    from = gas.clock.difference(last.until, start) * (1 - 0x1p-50);
  }
  kernels::Contact contact = first_contact(pair, from, to, kernel_counters_);
  if (contact.side_unknown) {
    settle_touch(a, b, shift);
    pair = make_pair(gas, a, first, b, second, shift);
    contact = first_contact(pair, from, to, kernel_counters_);
  }
  // A return that the clock cannot tell from the collision before.
  if (contact.found && pair.touch.collided && contact.elapsed.hi < 64 * gas.clock.resolution()) {
    contact.unresolvable = true;
  }
  if (shared) last_shared_ = {a, b, first.serial, second.serial, shift, until, contact};
  return contact;
}

// A record has just been made anew so near to touching another needle that rounding it may have
// moved it to the other side. The gap is continued from the records before.
template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::settle_touch(Needle a, Needle b, const Shift& shift) {
  ++counters.touches;
  const Record* first = &gas.records[a];
  const Record* second = &gas.records[b];
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
  const kernels::Pair before = make_pair(gas, a, *first, b, *second, old_shift);
  const Time start = Gas::start_of(*first, *second);
  const double elapsed = gas.clock.difference(now, start);
  kernels::Touch touch{.touching = true, .collided = false, .side = 0, .gap = 0};
  const kernels::Contact due =
      first_contact(before, elapsed * (1 - 0x1p-50), elapsed * (1 + 0x1p-50), kernel_counters_);
  if (due.found && gas.clock.add(start, due.elapsed.hi) <= now) {
    touch.side = due.side;  // a contact that is due now and has not happened yet
  } else {
    touch.gap = gap_at(before, gas.clock.exact_difference(now, start));
    touch.side = touch.gap > 0 ? 1 : touch.gap < 0 ? -1 : side_after(before);
  }
  Record& later = gas.records[a].time >= gas.records[b].time ? gas.records[a] : gas.records[b];
  const bool is_first = &later == &gas.records[a];
  later.touches.push_back({is_first ? b : a, is_first ? shift : -shift, touch});
}

// Three needles or more can collapse too, by hitting each other in turn. When that has come to
// where the clock stands still, more collisions happen at one instant than needles could have
// there.
template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::count_at_instant(Needle a, Needle b) {
  if (now != instant_) collisions_at_instant_ = 0;
  instant_ = now;
  if (++collisions_at_instant_ <= 64 + 2 * gas.size()) return;
  throw InvalidStateError("needles " + std::to_string(gas.ids[a]) + " and " +
                          std::to_string(gas.ids[b]) + " and others collapse at time " +
                          std::to_string(gas.clock.since_start(now)) + ": " +
                          std::to_string(collisions_at_instant_) +
                          " collisions at one instant; set collisions.tc_relative, to 1e-3 say");
}

template <class Search, class Calendar, Effects effects>
void EventLoop<Search, Calendar, effects>::report_collapse(const Event& event) const {
  const Needle a = event.lower(), b = event.higher();
  const Record& first = gas.records[a];
  const Record& second = gas.records[b];
  const kernels::Pair pair = make_pair(gas, a, first, b, second, event.shift);
  const Time start = Gas::start_of(first, second);
  const kernels::ContactGeometry contact =
      contact_geometry(pair, gas.clock.exact_difference(event.time, start));
  const double gap =
      gap_at(pair, gas.clock.exact_difference(event.time, start)) / contact.sin_angle;
  const std::string advice =
      restitution.epsilon == 0
          ? "with collisions.epsilon = 0 there is no rebound, and no contact time can help"
          : "set collisions.tc_relative, to 1e-3 say, so that they slide along each other";
  char numbers[160];
  std::snprintf(numbers, sizeof numbers, " at time %.17g, gap %.3g, back after %.3g",
                gas.clock.since_start(event.time), gap, gas.clock.difference(event.time, start));
  throw InvalidStateError("collapse of needles " + std::to_string(gas.ids[a]) + " and " +
                          std::to_string(gas.ids[b]) + numbers +
                          ": their next bounce is below what double resolves; " + advice);
}

}  // namespace needlework
