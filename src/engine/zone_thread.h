// One thread of a phase: processes the events of its zone, except those that must wait for events
// of other zones.
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

#include "src/calendar/cell_calendar.h"
#include "src/engine/event_processor.h"
#include "src/engine/patience.h"
#include "src/engine/phase.h"
#include "src/engine/tally.h"
#include "src/engine/undo_log.h"

namespace needlework {

/// Puts events into the calendar and lists the blocks that the present event has changed.
struct ZoneChanges final : EventSink {
  explicit ZoneChanges(CellCalendar& its_calendar) : EventSink(true), calendar(its_calendar) {}
  void set(const Event& event, BlockIndex block) override { calendar.put(event, block, changed); }

  CellCalendar& calendar;
  std::vector<BlockIndex> changed;
};

template <Search S, Model M>
class alignas(128) ZoneThread {
 public:
  ZoneThread(Phase<S>& phase, const M& model, std::uint32_t zone)
      : phase_(phase),
        model_(model),
        zone_(zone),
        changes_(phase.calendar),
        search_(phase.search, tally_.counters),
        processor_(phase.run, model, search_, changes_, tally_) {
    processor_.undo = &undo_;
  }
  ZoneThread(const ZoneThread&) = delete;
  ZoneThread& operator=(const ZoneThread&) = delete;

  /// Starts a new phase.
  void begin();
  /// Processes the events of the zone before `end`: all of them, unless the phase has to be
  /// undone.
  void work(TimeKey end);
  /// Restores the records that the thread has replaced in the phase, and appends the needles whose
  /// events must be predicted again.
  void undo(std::vector<Needle>& needles);
  /// To be called when the order of the storage has changed.
  void forget() { processor_.forget(); }

  // Results of the phase.
  /// The time of the latest event processed, which need not be the last one processed.
  Time latest() const { return latest_; }
  Tally& tally() { return tally_; }
  const std::vector<Collision>& reports() const { return reports_; }

 private:
  using Block = CellCalendar::Block;

  // An event that must wait until `for_block` has no earlier one.
  struct Held {
    Block block, for_block;
    TimeKey key;
  };

  enum class Outcome { done, held, again };

  Outcome attempt(Block block, TimeKey key);
  Outcome hold(Block block, TimeKey key, Block for_block);
  void release_held();
  void read_mail();
  void publish_changes();
  Block earlier_around(Block centre, Block block, TimeKey key) const;
  static double speed_of(const Record& record) {
    const Vec3d& v = record.flight.v;
    return std::sqrt(dot(v, v));
  }
  Done take(Needle i, const Event& event, TimeKey key) const;
  CellBox cells_of(Needle i, const Vec3d& r) const;
  bool may_have_met(const Done& mine, double speed, bool in_order, bool alone) const;

  // Largest number of waiting events while the thread looks for one that can proceed.
  static constexpr std::size_t most_held = 12;
  static constexpr Block nobody = ~Block{0};

  Phase<S>& phase_;
  const M& model_;
  const std::uint32_t zone_;
  Tally tally_;
  ZoneChanges changes_;
  S search_;
  EventProcessor<S, M> processor_;
  UndoLog undo_;
  std::vector<Held> held_;
  TimeKey next_of_others_ = 0;  ///< earliest event of other zones, as last seen
  TimeKey hindmost_ = 0;        ///< earliest event of all zones, as last seen
  std::vector<Collision> reports_;
  Time latest_;
};

template <Search S, Model M>
void ZoneThread<S, M>::begin() {
  undo_.clear();
  reports_.clear();
  held_.clear();
  latest_ = phase_.run.now;
  processor_.set_now(latest_);
  processor_.reports = phase_.run.callback ? &reports_ : nullptr;
}

template <Search S, Model M>
void ZoneThread<S, M>::undo(std::vector<Needle>& needles) {
  undo_.put_back(phase_.run.gas, phase_.run.last_collision);
  needles.insert(needles.end(), undo_.scheduled().begin(), undo_.scheduled().end());
  processor_.forget();
}

template <Search S, Model M>
void ZoneThread<S, M>::work(TimeKey end) {
  Patience patience(phase_.spins);
  BlockedTime blocked_time;
  const auto go_on = [&] {
    patience.reset();
    blocked_time.end(tally_.counters.turns, tally_.counters.blocked);
  };
  const auto wait = [&] {
    blocked_time.begin();
    if (patience.wait() && phase_.may_be_too_slow && blocked_time.is_most(Phase<S>::longest_wait)) {
      phase_.too_slow = phase_.amiss = true;
    }
  };
  while (!phase_.amiss.load(std::memory_order_relaxed)) {
    if (phase_.mail.has_some(zone_)) read_mail();
    release_held();
    const TimeKey key = phase_.calendar.winning_key(zone_);
    TimeKey front = key;
    for (const Held& held : held_) front = std::min(front, held.key);
    phase_.fronts.publish_next(zone_, front);
    // Held events may be waiting for an earlier one that has appeared since.
    const bool may_start = held_.size() < most_held || key == front;
    next_of_others_ = phase_.fronts.next_of_others(zone_);
    hindmost_ = std::min(front, next_of_others_);
    if (key < end && may_start && !phase_.fronts.is_too_far_ahead(key, hindmost_)) {
      const Outcome outcome = attempt(phase_.calendar.winner(zone_), key);
      if (outcome == Outcome::done) go_on();
      if (outcome == Outcome::again) wait();
      continue;
    }
    if (key >= end && held_.empty()) {
      blocked_time.begin();
      if (phase_.mail.rest(zone_, phase_.amiss, Patience(phase_.spins))) break;
      continue;
    }
    ++tally_.counters.waited;
    wait();
  }
  go_on();
}

// Processes the next event of a block, unless it must wait.
template <Search S, Model M>
auto ZoneThread<S, M>::attempt(Block block, TimeKey key) -> Outcome {
  const bool alone = phase_.inner[block] && held_.empty();
  processor_.prefetch(phase_.calendar.likely_next_in(zone_));
  const auto give_up = [&](Block for_block) {
    phase_.claims.drop(zone_);
    return for_block == nobody ? Outcome::again : hold(block, key, for_block);
  };
  const auto claim = [&](Claims::Part part, const CellBox& box) {
    return alone || phase_.claims.claim(zone_, part, box);
  };
  if (!alone) {
    ++tally_.counters.border;
    const Block earlier = earlier_around(block, block, key);
    if (earlier != nobody) return give_up(earlier);
    if (!claim(Claims::owner, phase_.cell_of(block))) return Outcome::again;
    // Another thread may have changed this block, or others of the zone near it, just before the
    // claim.
    if (phase_.calendar.published_key(block) != key || phase_.mail.has_some(zone_)) {
      return give_up(nobody);
    }
  }
  const Event event = phase_.calendar.top_of(block);
  if (event.has_partner()) {
    phase_.calendar.prefetch_place(event.partner);
    processor_.prefetch(event.partner);
  }
  phase_.calendar.prefetch_keys(block);
  bool stale = false, near_partner = false;
  if (event.has_partner()) {
    // If the partner is no longer near, it has collided since the prediction.
    const Block other = phase_.calendar.block_of(event.partner);
    const CellBox here = phase_.cell_of(block), there = phase_.cell_of(other);
    near_partner = near(here, there, phase_.cells, phase_.neighbours);
    stale = !near_partner;
    if (near_partner) {
      if (!alone && other != block) {
        const Block earlier = earlier_around(other, block, key);
        if (earlier != nobody) return give_up(earlier);
      }
      if (!claim(Claims::partner, there)) return Outcome::again;
      if (phase_.calendar.block_of(event.partner) != other) return give_up(nobody);
      phase_.calendar.prefetch_keys(other);
      stale = processor_.is_stale(event);
      if (!stale && phase_.calendar.of(event.partner) < event) {
        // The event would replace one that comes before it, by less than keys can tell.
        phase_.amiss = true;
        return give_up(nobody);
      }
    }
  }
  const bool changes_partner = event.has_partner() && !stale;
  const Done owner = take(event.owner, event, key);
  phase_.done.prefetch(owner.r);
  if (!claim(Claims::owner, cells_of(event.owner, owner.r))) return Outcome::again;
  Done partner;
  if (changes_partner) {
    partner = take(event.partner, event, key);
    phase_.done.prefetch(partner.r);
    if (!claim(Claims::partner, cells_of(event.partner, partner.r))) return Outcome::again;
  } else if (stale && near_partner && phase_.run.gas.records[event.partner].time > event.time) {
    // The contact might have taken place, had it been processed in its turn.
    phase_.amiss = true;
    return give_up(nobody);
  }
  const double fastest = changes_partner ? std::max(owner.speed, partner.speed) : owner.speed;
  const bool in_order = phase_.fronts.publish_event(zone_, key, fastest);
  changes_.changed.clear();
#ifndef NDEBUG
  processor_.watch_reading_ahead();
#endif
  processor_.process(event, stale);
  latest_ = std::max(latest_, event.time);
  if (tally_.collisions > phase_.most_collisions) phase_.too_many = phase_.amiss = true;
  const auto record = [&](Needle i, const Done& taken) {
    const double speed = speed_of(phase_.run.gas.records[i]);
    if (may_have_met(taken, speed, in_order, alone)) phase_.amiss = true;
    phase_.done.add(taken, hindmost_);
  };
  record(event.owner, owner);
  if (changes_partner) record(event.partner, partner);
  // No event reads a record from later than its own time, unless the phase is undone.
  assert(!processor_.has_read_ahead() || phase_.amiss);
  publish_changes();
  if (!alone) phase_.claims.drop(zone_);
  return Outcome::done;
}

template <Search S, Model M>
auto ZoneThread<S, M>::hold(Block block, TimeKey key, Block for_block) -> Outcome {
  ++tally_.counters.held;
  held_.push_back({block, for_block, key});
  phase_.calendar.follow_by_key(block, CellCalendar::no_event);
  return Outcome::held;
}

// Releases held events that may be able to proceed.
template <Search S, Model M>
void ZoneThread<S, M>::release_held() {
  std::erase_if(held_, [&](const Held& held) {
    look_away();
    const TimeKey published = phase_.calendar.published_key(held.for_block);
    if (published < held.key || (published == held.key && held.for_block < held.block)) {
      return false;
    }
    phase_.calendar.follow_by_key(held.block, phase_.calendar.published_key(held.block));
    return true;
  });
}

template <Search S, Model M>
void ZoneThread<S, M>::read_mail() {
  for (const Block block : phase_.mail.take(zone_)) {
    std::erase_if(held_, [&](const Held& held) { return held.block == block; });
    phase_.calendar.follow_by_key(block, phase_.calendar.published_key(block));
  }
}

// Publishes the times of the blocks that an event has changed. Those that have become earlier are
// published first, so that no thread sees this event completed without the events that follow from
// it.
template <Search S, Model M>
void ZoneThread<S, M>::publish_changes() {
  std::vector<Block>& changed = changes_.changed;
  look_away();
  for (const Block b : changed) {
    if (phase_.calendar.next_key(b) < phase_.calendar.published_key(b)) phase_.calendar.publish(b);
  }
  for (const Block b : changed) {
    look_away();
    phase_.calendar.publish(b);
    const std::uint32_t zone = phase_.calendar.zone_of(b);
    if (zone == zone_) {
      std::erase_if(held_, [&](const Held& held) { return held.block == b; });
      phase_.calendar.follow_by_key(b, phase_.calendar.published_key(b));
      continue;
    }
    ++tally_.counters.foreign;
    phase_.mail.send(zone, b);
  }
}

// A block within reach of `centre` that has an event before that of `block`, or nobody. Among the
// zone's own blocks only held ones can have one.
template <Search S, Model M>
auto ZoneThread<S, M>::earlier_around(Block centre, Block block, TimeKey key) const -> Block {
  look_away();
  for (const Held& held : held_) {
    const bool before = held.key < key || (held.key == key && held.block < block);
    if (before && phase_.reach.holds(phase_.places[centre], phase_.places[held.block])) {
      return held.block;
    }
  }
  Block found = nobody;
  if (key < next_of_others_) return found;
  const auto has_earlier = [&](Block first, Block end) {
    for (Block b = first; b < end; ++b) {
      const TimeKey published = phase_.calendar.published_key(b);
      if (published > key || (published == key && b >= block)) continue;
      found = b;
      return true;
    }
    return false;
  };
  if (phase_.calendar.zone_of(centre) != zone_) {
    phase_.reach.any_row(phase_.places[centre], has_earlier);
    return found;
  }
  for (std::uint32_t n = phase_.foreign_from[centre]; n < phase_.foreign_from[centre + 1]; ++n) {
    if (has_earlier(phase_.foreign[n].first, phase_.foreign[n].end)) break;
  }
  return found;
}

template <Search S, Model M>
auto ZoneThread<S, M>::take(Needle i, const Event& event, TimeKey key) const -> Done {
  const Record& record = phase_.run.gas.records[i];
  const double elapsed = phase_.run.gas.clock.difference(event.time, record.time);
  return {
      key,       model_.centre(record, elapsed), speed_of(record), event.lower_id, event.higher_id,
      event.time};
}

// The box of cells around the cell of a needle at r and the cells in which it may be placed.
template <Search S, Model M>
CellBox ZoneThread<S, M>::cells_of(Needle i, const Vec3d& r) const {
  return cells_around(phase_.search.grid(), r,
                      phase_.search.radius() * (1 + 0x1p-10) + phase_.run.gas.longest * 0x1p-20,
                      phase_.search.cell_of(i));
}

// Whether a needle that has had event `mine`, and flies with `speed` since, may have met a needle
// whose later event has already been processed, before that later event. `in_order`: this thread
// has processed no later event. `alone`: no other thread works near.
template <Search S, Model M>
bool ZoneThread<S, M>::may_have_met(const Done& mine, double speed, bool in_order,
                                    bool alone) const {
  const double farthest = phase_.fronts.reach_of_later(zone_, mine.key, speed, in_order);
  if (farthest == 0) return false;
  if (phase_.fronts.is_out_of_sight(farthest)) return true;
  return !(alone && in_order) && phase_.done.may_have_met(mine, speed, farthest);
}

}  // namespace needlework
