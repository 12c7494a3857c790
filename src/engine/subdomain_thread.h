// One thread of a phase: processes the events of its subdomain, except those that must wait for
// events of other subdomains.
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "src/calendar/cell_calendar.h"
#include "src/engine/backoff.h"
#include "src/engine/event_processor.h"
#include "src/engine/phase.h"
#include "src/engine/rollback_log.h"
#include "src/engine/tally.h"

namespace needlework {

/// Puts events into the calendar and lists what the present event has changed.
struct SubdomainChanges final : EventSink {
  struct Change {
    Needle needle;
    std::uint32_t before;  ///< the subdomain in which the needle was
  };

  explicit SubdomainChanges(CellCalendar& its_calendar) : EventSink(true), calendar(its_calendar) {}
  void set(const Event& event, CellIndex cell) override {
    needles.push_back({event.owner, calendar.subdomain_of(calendar.cell_of(event.owner))});
    calendar.put(event, cell, cells);
  }
  void prefetch(Needle i, CellIndex cell) const override { calendar.prefetch(i, cell); }

  CellCalendar& calendar;
  std::vector<Change> needles;
  std::vector<CellIndex> cells;  ///< whose keys may have changed
};

/// The order in which happenings are reported.
inline bool comes_before(const Happening* a, const Happening* b) {
  const auto key = [](const Happening& h) {
    const Collision& c = h.event;
    return std::tie(c.epoch, c.offset, h.source, c.first, c.second, c.shift);
  };
  return key(*a) < key(*b);
}

template <Search S, Model M>
class alignas(128) SubdomainThread {
 public:
  SubdomainThread(Phase<S>& phase, const M& model, std::uint32_t subdomain)
      : phase_(phase),
        subdomain_(subdomain),
        changes_(phase.calendar),
        search_(phase.search, tally_.counters),
        processor_(phase.run, model, search_, changes_, tally_) {
    processor_.reports = &reports_;
    processor_.rollback_log = &rollback_log_;
  }
  SubdomainThread(const SubdomainThread&) = delete;
  SubdomainThread& operator=(const SubdomainThread&) = delete;

  /// Searches with other threads the first events of needles, before a phase.
  void begin_searches();
  /// The first event of a needle that is found until then, or nothing if other threads must not
  /// work meanwhile.
  std::optional<Event> find(Needle i, Time placed_until);
  /// Starts a new phase.
  void begin();
  /// Processes the events of the subdomain before `end`: all of them, unless the phase has to be
  /// rolled back.
  void work(TimeKey end);
  /// Restores the records that the thread has replaced in the phase, and appends the needles whose
  /// events must be predicted again.
  void roll_back(std::vector<Needle>& needles);
  /// To be called when the order of the storage has changed.
  void forget() { processor_.forget(); }

  // Results of the phase.
  /// The time of the latest event processed, which need not be the last one processed.
  Time latest() const { return latest_; }
  Tally& tally() { return tally_; }
  /// What has happened, in order of time, if it is to be reported, and times of collisions in any
  /// order.
  const std::vector<const Happening*>& reports() const { return sorted_reports_; }
  const std::vector<double>& times() const { return reports_.times; }

 private:
  static constexpr CellIndex nobody = ~CellIndex{0};

  // What an event waits for: that a cell has no earlier one, or that another thread changes its
  // lock.
  struct Obstacle {
    CellIndex cell = nobody;
    RegionLocks::Conflict lock{};
    bool is_lock() const { return cell == nobody; }
  };
  struct Deferred {
    Needle needle;
    CellIndex cell;
    TimeKey key;
    Obstacle obstacle;
  };

  // What came of an attempt: the event has been processed; it has been deferred or replaced, and
  // another one is next; or other threads are in the way.
  enum class Outcome { done, other, blocked };

  Outcome attempt(Needle i, TimeKey key);
  void release_deferred();
  void read_mail();
  void publish_changes();
  void notify(std::uint32_t subdomain, Needle i);
  void follow(Needle i);
  void prefetch(Needle i) const {
    phase_.calendar.prefetch(i);
    processor_.prefetch(i);
  }
  std::optional<Obstacle> earlier_around(const Vec3d& r, CellIndex centre, CellIndex cell,
                                         TimeKey key) const;
  void sort_reports();
  // A needle of the event that is attempted, and the cell of the log to which it belongs.
  struct Taken {
    LoggedEvent event;
    std::size_t cell = 0;
  };
  Taken take(Needle i, const Event& event, TimeKey key) const;
  CellBox cells_of(Needle i, const Vec3d& r) const;
  bool is_near(CellIndex a, CellIndex b) const {
    return near(phase_.box_of(a), phase_.box_of(b), phase_.cells, phase_.neighbours);
  }
  bool may_have_met(const LoggedEvent& mine, double speed, const LocalTimes::Seen& seen,
                    bool inner) const;

  // Largest number of waiting events while the thread looks for one that can proceed.
  static constexpr std::size_t most_deferred = 12;

  Phase<S>& phase_;
  const std::uint32_t subdomain_;
  Tally tally_;
  SubdomainChanges changes_;
  S search_;
  EventProcessor<S, M> processor_;
  RollbackLog rollback_log_;
  std::vector<Deferred> deferred_;
  TimeKey next_of_others_ = 0;  ///< earliest event of other subdomains, as last seen
  TimeKey hindmost_ = 0;        ///< earliest event of all subdomains, as last seen
  Reports reports_;
  std::vector<const Happening*> sorted_reports_;
  Time latest_;
};

template <Search S, Model M>
void SubdomainThread<S, M>::begin_searches() {
  processor_.set_now(phase_.run.now);
  processor_.share_records(true);
}

template <Search S, Model M>
std::optional<Event> SubdomainThread<S, M>::find(Needle i, Time placed_until) {
  try {
    return processor_.find(i, placed_until);
  } catch (...) {
    // If the error is real, the thread that searches alone meets it too.
    return std::nullopt;
  }
}

template <Search S, Model M>
void SubdomainThread<S, M>::begin() {
  processor_.share_records(false);
  reports_.happenings.clear();
  reports_.times.clear();
  deferred_.clear();
  latest_ = phase_.run.now;
  rollback_log_.begin(latest_);
  processor_.set_now(latest_);
}

template <Search S, Model M>
void SubdomainThread<S, M>::roll_back(std::vector<Needle>& needles) {
  rollback_log_.put_back(phase_.run.gas);
  needles.insert(needles.end(), rollback_log_.scheduled().begin(), rollback_log_.scheduled().end());
  processor_.forget();
}

template <Search S, Model M>
void SubdomainThread<S, M>::work(TimeKey end) {
  Backoff backoff(phase_.spins);
  BlockedTime blocked_time;
  const auto go_on = [&] {
    backoff.reset();
    blocked_time.end(tally_.counters.stalls, tally_.counters.blocked);
  };
  const auto wait = [&] {
    blocked_time.begin();
    if (backoff.wait() && phase_.may_be_too_slow && blocked_time.is_most(Phase<S>::longest_wait)) {
      phase_.too_slow = phase_.must_roll_back = true;
    }
  };
  while (!phase_.must_roll_back.load(std::memory_order_relaxed)) {
    if (phase_.mail.has_some(subdomain_)) read_mail();
    release_deferred();
    const TimeKey key = phase_.calendar.winning_key(subdomain_);
    TimeKey local_time = key;
    for (const Deferred& deferred : deferred_) local_time = std::min(local_time, deferred.key);
    phase_.local_times.publish_next(subdomain_, local_time);
    // Deferred events may be waiting for an earlier one that has appeared since.
    const bool may_start = deferred_.size() < most_deferred || key == local_time;
    next_of_others_ = phase_.local_times.next_of_others(subdomain_);
    hindmost_ = std::min(local_time, next_of_others_);
    if (key < end && may_start && !phase_.local_times.is_too_far_ahead(key, hindmost_)) {
      const Outcome outcome = attempt(phase_.calendar.winner(subdomain_), key);
      if (outcome == Outcome::done) go_on();
      if (outcome == Outcome::blocked) wait();
      continue;
    }
    if (key >= end && deferred_.empty()) {
      blocked_time.begin();
      if (phase_.mail.rest(subdomain_, phase_.must_roll_back, Backoff(phase_.spins))) break;
      continue;
    }
    ++tally_.counters.waited;
    wait();
  }
  go_on();
  sort_reports();
}

template <Search S, Model M>
void SubdomainThread<S, M>::sort_reports() {
  sorted_reports_.clear();
  if (phase_.must_roll_back) return;
  for (const Happening& happening : reports_.happenings) sorted_reports_.push_back(&happening);
  std::sort(sorted_reports_.begin(), sorted_reports_.end(), comes_before);
}

// Processes the event of a needle, which is the next one, unless it must wait.
template <Search S, Model M>
auto SubdomainThread<S, M>::attempt(Needle i, TimeKey key) -> Outcome {
  prefetch(i);
  prefetch(phase_.calendar.likely_next_in(subdomain_));
  const CellIndex cell = phase_.calendar.cell_of(i);
  // Else it has just left, and mail is on its way.
  if (phase_.calendar.subdomain_of(cell) != subdomain_) return Outcome::blocked;
  const bool inner = phase_.inner[cell];
  const auto give_up = [&] {
    phase_.region_locks.release(subdomain_);
    return Outcome::other;
  };
  const auto defer = [&](const Obstacle& obstacle) {
    ++tally_.counters.deferred;
    deferred_.push_back({i, cell, key, obstacle});
    phase_.calendar.follow(i, subdomain_, CellCalendar::no_event);
    return give_up();
  };
  const auto roll_back = [&] {
    phase_.must_roll_back = true;
    return give_up();
  };
  const auto lock = [&](RegionLocks::Part part, const CellBox& box) {
    return inner ? std::nullopt : phase_.region_locks.acquire(subdomain_, part, box);
  };
  // Waits for the lock unless another event can be processed meanwhile.
  const auto wait_for = [&](const RegionLocks::Conflict& conflict) {
    for (const Deferred& deferred : deferred_) {
      if (deferred.obstacle.is_lock()) return Outcome::blocked;
    }
    return defer({nobody, conflict});
  };
  if (!inner) {
    ++tally_.counters.border;
    if (const auto conflict = lock(RegionLocks::owner, phase_.box_of(cell))) {
      return wait_for(*conflict);
    }
    // Another thread may have changed this event, or others of the subdomain near it, just before
    // the lock.
    if (phase_.calendar.key_of(i) != key || phase_.calendar.cell_of(i) != cell ||
        phase_.mail.has_some(subdomain_)) {
      return give_up();
    }
  }
  assert(phase_.calendar.key_of(i) == key);
  const Event event = phase_.calendar.of(i);
  if (event.has_partner()) prefetch(event.partner);
  const Taken owner = take(event.owner, event, key);
  const bool may_wait = !inner || !deferred_.empty();
  if (may_wait) {
    if (const auto earlier = earlier_around(owner.event.r, cell, cell, key)) {
      return defer(*earlier);
    }
  }
  std::optional<Taken> partner;  // unless the event changes the owner alone
  if (event.has_partner()) {
    // If the partner is no longer near, it has collided since the prediction.
    const CellIndex other = phase_.calendar.cell_of(event.partner);
    if (is_near(cell, other)) {
      if (const auto conflict = lock(RegionLocks::partner, phase_.box_of(other))) {
        return wait_for(*conflict);
      }
      if (phase_.calendar.cell_of(event.partner) != other) return give_up();
      if (!processor_.is_stale(event)) {
        partner = take(event.partner, event, key);
      } else if (phase_.run.gas.records[event.partner].time > event.time) {
        // The contact might have taken place, had it been processed in its turn.
        return roll_back();
      }
    }
    if (partner && may_wait) {
      if (const auto earlier = earlier_around(partner->event.r, other, cell, key)) {
        return defer(*earlier);
      }
    }
    // The event would replace one that comes before it, by less than keys can tell.
    if (partner && phase_.calendar.of(event.partner) < event) return roll_back();
  }
  const bool stale = event.has_partner() && !partner;
  if (!inner) {
    if (const auto conflict = lock(RegionLocks::owner, cells_of(event.owner, owner.event.r))) {
      return wait_for(*conflict);
    }
    if (partner) {
      const CellBox there = cells_of(event.partner, partner->event.r);
      if (const auto conflict = lock(RegionLocks::partner, there)) return wait_for(*conflict);
    }
  }
  double fastest = owner.event.speed;
  if (partner) fastest = std::max(fastest, partner->event.speed);
  const LocalTimes::Seen seen = phase_.local_times.publish_event(subdomain_, key, fastest);
  changes_.needles.clear();
  changes_.cells.clear();
#ifndef NDEBUG
  processor_.watch_reading_ahead();
#endif
  processor_.process(event, stale);
  latest_ = std::max(latest_, event.time);
  if (tally_.collisions > phase_.most_collisions) phase_.too_many = phase_.must_roll_back = true;
  const auto check = [&](Needle i, const Taken& taken) {
    assert(is_near(cell, phase_.calendar.cell_of(i)) &&
           is_near(cell, static_cast<CellIndex>(taken.cell)));
    const double speed = phase_.run.gas.fastest_of(phase_.run.gas.records[i]);
    if (may_have_met(taken.event, speed, seen, inner)) phase_.must_roll_back = true;
  };
  check(event.owner, owner);
  if (partner) check(event.partner, *partner);
  phase_.causality_log.add(owner.event, owner.cell, hindmost_);
  if (partner) phase_.causality_log.add(partner->event, partner->cell, hindmost_);
  // No event reads a record from later than its own time, unless the phase is rolled back.
  assert(!processor_.has_read_ahead() || phase_.must_roll_back);
  publish_changes();
  if (!inner) phase_.region_locks.release(subdomain_);
  return Outcome::done;
}

// Releases deferred events that may be able to proceed.
template <Search S, Model M>
void SubdomainThread<S, M>::release_deferred() {
  std::erase_if(deferred_, [&](const Deferred& deferred) {
    random_pause();
    if (deferred.obstacle.is_lock()) {
      if (phase_.region_locks.lasts(deferred.obstacle.lock)) return false;
    } else {
      const CellIndex other = deferred.obstacle.cell;
      assert(phase_.calendar.is_shown(other));
      const TimeKey published = phase_.calendar.published_key(other);
      if (published < deferred.key || (published == deferred.key && other < deferred.cell)) {
        return false;
      }
    }
    phase_.calendar.follow(deferred.needle, subdomain_, deferred.key);
    return true;
  });
}

template <Search S, Model M>
void SubdomainThread<S, M>::read_mail() {
  for (const Needle i : phase_.mail.take(subdomain_)) follow(i);
}

// Publishes the keys of the cells that an event has changed, and lets the subdomains concerned
// know of the needles. Keys that have become earlier are published first, so that no thread sees
// this event completed without the events that follow from it.
template <Search S, Model M>
void SubdomainThread<S, M>::publish_changes() {
  random_pause();
  for (const CellIndex c : changes_.cells) {
    if (phase_.calendar.first_key(c) < phase_.calendar.published_key(c)) phase_.calendar.publish(c);
  }
  for (const CellIndex c : changes_.cells) {
    random_pause();
    phase_.calendar.publish(c);
  }
  for (const auto& [i, before] : changes_.needles) {
    const std::uint32_t now = phase_.calendar.subdomain_of(phase_.calendar.cell_of(i));
    notify(now, i);
    if (before != now) notify(before, i);
  }
}

// Lets a subdomain know that the event of a needle, which is or was there, has been replaced.
template <Search S, Model M>
void SubdomainThread<S, M>::notify(std::uint32_t subdomain, Needle i) {
  if (subdomain == subdomain_) return follow(i);
  ++tally_.counters.messages;
  phase_.mail.send(subdomain, i);
}

// Updates the tournament for a needle that is, or was, in the subdomain.
template <Search S, Model M>
void SubdomainThread<S, M>::follow(Needle i) {
  std::erase_if(deferred_, [&](const Deferred& deferred) { return deferred.needle == i; });
  const bool is_here = phase_.calendar.subdomain_of(phase_.calendar.cell_of(i)) == subdomain_;
  phase_.calendar.follow(i, subdomain_,
                         is_here ? phase_.calendar.key_of(i) : CellCalendar::no_event);
}

// A cell in sight of r, of a needle in the cell `centre`, that has an event before that of
// `cell`; what that event waits for, if no cell can tell when it has been processed; or nothing.
// Among the subdomain's own cells only deferred ones can have one.
template <Search S, Model M>
auto SubdomainThread<S, M>::earlier_around(const Vec3d& r, CellIndex centre, CellIndex cell,
                                           TimeKey key) const -> std::optional<Obstacle> {
  random_pause();
  const Vec3d position = phase_.search.grid().in_sides(r);
  for (const Deferred& deferred : deferred_) {
    const bool before = deferred.key < key || (deferred.key == key && deferred.cell < cell);
    if (before && phase_.in_sight.comes_near(position, phase_.places[deferred.cell])) {
      // Only cells that are shown tell when the event has been processed.
      return phase_.calendar.is_shown(deferred.cell) ? Obstacle{deferred.cell} : deferred.obstacle;
    }
  }
  std::optional<Obstacle> found;
  if (key < next_of_others_) return found;
  const auto has_earlier = [&](CellIndex first, CellIndex end) {
    for (CellIndex c = first; c < end; ++c) {
      assert(phase_.calendar.is_shown(c) || phase_.calendar.subdomain_of(c) == subdomain_);
      const TimeKey published = phase_.calendar.published_key(c);
      if (published > key || (published == key && c >= cell)) continue;
      if (!phase_.in_sight.comes_near(position, phase_.places[c])) continue;
      found = Obstacle{c};
      return true;
    }
    return false;
  };
  if (phase_.calendar.subdomain_of(centre) != subdomain_) {
    phase_.in_sight.any_row(phase_.places[centre], has_earlier);
    return found;
  }
  for (std::uint32_t n = phase_.remote_from[centre]; n < phase_.remote_from[centre + 1]; ++n) {
    if (has_earlier(phase_.remote[n].first, phase_.remote[n].end)) break;
  }
  return found;
}

template <Search S, Model M>
auto SubdomainThread<S, M>::take(Needle i, const Event& event, TimeKey key) const -> Taken {
  const Record& record = phase_.run.gas.records[i];
  const Gas& gas = phase_.run.gas;
  const Vec3d r = gas.across_flow(gas.motion_from(record, event.time).centre());
  const std::size_t cell = phase_.causality_log.cell_of(r);
  phase_.causality_log.prefetch(cell);
  return {{key, r, gas.fastest_of(record), !event.has_partner(), event.time}, cell};
}

// The box of cells around the cell of a needle at r and the cells in which it may be placed.
template <Search S, Model M>
CellBox SubdomainThread<S, M>::cells_of(Needle i, const Vec3d& r) const {
  return cells_around(phase_.search.grid(), r,
                      phase_.search.radius() * (1 + 0x1p-10) + phase_.run.gas.longest * 0x1p-20 +
                          phase_.run.gas.margin,
                      phase_.search.cell_of(i));
}

// Whether a needle that has had event `mine`, and flies with `speed` since, may have met a needle
// whose later event has already been processed, before that later event. `inner`: no other thread
// works near.
template <Search S, Model M>
bool SubdomainThread<S, M>::may_have_met(const LoggedEvent& mine, double speed,
                                         const LocalTimes::Seen& seen, bool inner) const {
  const double farthest = phase_.local_times.reach_of_later(seen, mine.key, speed);
  if (farthest == 0) return false;
  if (phase_.local_times.is_out_of_sight(farthest)) return true;
  return !(inner && seen.in_order) && phase_.causality_log.may_have_met(mine, speed, farthest);
}

}  // namespace needlework
