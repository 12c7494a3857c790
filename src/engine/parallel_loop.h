// The event loop on several threads, with the trajectory of one.
//
// Each thread has a zone of the box and makes the events of the needles there happen, the earliest
// first. What an event reads and writes lies within some cells of it, so events far from each other
// may happen in any order, or at once. An event waits while the clock of any block within `reach_`
// cells is behind it; other events of the zone, far from the waiting ones, go on. A thread waits as
// well while another is very far behind in time. Where zones are near, a thread claims the cells
// that its event may write to before it reads any.
//
// That is nearly always enough, and nothing of the kind can be enough for sure: between two needles
// there may be a row of others that hand a push on in no time, from an event outside the reach to
// one that has been done. So every event looks for later ones that have been done near it. They do
// no harm unless the needles of both may meet in the time between: until then nothing that one does
// can matter to the other, and from then on each has been searched after the other was placed. When
// they may, or when anything else has gone amiss, the whole phase since the threads last met is
// undone, and one thread does it again. Counters tell how often (`redone`).
//
// The same serves ends that lie at one collision of the total order: a phase in which one is passed
// is done again by one thread, which stops there.
#pragma once

#include <omp.h>

#include <atomic>
#include <cassert>
#include <deque>
#include <mutex>

#include "src/calendar/cell_calendar.h"
#include "src/engine/cell_box.h"
#include "src/engine/claims.h"
#include "src/engine/done_log.h"
#include "src/engine/event_loop.h"
#include "src/engine/fronts.h"
#include "src/engine/patience.h"
#include "src/engine/phase_plan.h"
#include "src/engine/zones.h"
#include "src/search/cell_grid.h"

namespace needlework {

/// What a thread needs of the calendar, and what it has changed there in the event at hand.
struct ZoneQueue {
  void set(const Event& event, CellCalendar::Block block) { calendar.put(event, block, changed); }

  CellCalendar& calendar;
  std::vector<CellCalendar::Block> changed;
};

template <class Search, Effects effects>
class ParallelLoop final : public EventLoop<Search, CellCalendar, effects> {
  using Base = EventLoop<Search, CellCalendar, effects>;
  using Block = CellCalendar::Block;
  using Base::queue_;
  using Base::run_;
  using Base::search_;

 public:
  // How far from its cell an event looks for earlier ones. Where it is shorter, phases are undone
  // again and again; longer, events wait for nothing. [L]
  static constexpr double usual_sight = 1.5;

  ParallelLoop(Run& run, const SearchSetup& setup, int threads, double sight = usual_sight,
               double least = PhasePlan::usual_least);

  std::optional<Stop> advance(const Limits& limits) override;

 private:
  // An event that has to wait until the clock of `for_block` is past it.
  struct Held {
    Block block, for_block;
    TimeKey key;
  };

  // A thread.
  struct alignas(128) Hand {
    Hand(ParallelLoop& loop, std::uint32_t number)
        : zone(number),
          queue{loop.queue_, {}},
          search(loop.search_, tally.counters),
          worker(loop.run_, search, queue, tally) {
      worker.undo = &undo;
    }

    std::uint32_t zone;
    Tally tally;
    ZoneQueue queue;
    Search search;
    Worker<Search, ZoneQueue, effects> worker;
    UndoLog undo;
    std::vector<Held> held;
    std::vector<Collision> reports;
    alignas(128) std::atomic<bool> has_mail = false;
    std::vector<Block> mail;  ///< its blocks to which others have written
    bool resting = false;
  };

  enum class Outcome { done, held, again };

  void divide();
  void sort_storage() override {
    Base::sort_storage();
    divide();
  }
  void run_together(const Limits& limits, Time end);
  void undo();
  void report();

  void work(Hand& me, TimeKey end);
  Outcome attempt(Hand& me, Block block, TimeKey key);
  Outcome hold(Hand& me, Block block, TimeKey key, Block for_block);
  void release_held(Hand& me);
  void read_mail(Hand& me);
  bool rest(Hand& me);
  void make_known(Hand& me);

  /// Collisions in a time, by the mean free time.
  double thermal_rate() const {
    return 0.5 * static_cast<double>(run_.gas.size()) / run_.mean_free_time;
  }
  double thermal_speed() const { return std::sqrt(std::max(0.0, run_.energy())); }
  CellBox cell_of(Block block) const { return {places_[block], {}}; }
  Block earlier_around(const Hand& me, Block centre, Block block, TimeKey key) const;
  Done take(Needle i, const Event& event, TimeKey key) const;
  CellBox cells_of(Needle i, const Vec3d& r) const;
  bool may_have_met(const Hand& me, const Done& mine, double speed, bool in_order,
                    bool alone) const;

  // Events that wait while a thread looks for one that need not.
  static constexpr std::size_t most_held = 12;
  static constexpr Block nobody = ~Block{0};

  CellCounts cells_;
  double sight_of_done_;   ///< others may be at work where what has been done is farther [L]
  CellCounts neighbours_;  ///< what needles of a cell read is not farther than this
  CellBall reach_;         ///< where an event looks for earlier ones
  CellCounts apart_;       ///< events farther than this never touch the same
  Claims claims_;
  DoneLog done_;                     ///< in this phase
  std::vector<std::uint8_t> inner_;  ///< of a block: nobody else ever comes near
  std::vector<std::uint8_t> ours_;   ///< of a block: all within reach are of its zone
  std::vector<CellCounts> places_;   ///< of the blocks
  std::deque<Hand> hands_;
  std::atomic<bool> amiss_ = false, finished_ = false;
  std::atomic<bool> too_many_ = false;  ///< collisions, for a phase
  Fronts fronts_;
  double fastest_to_thermal_;  ///< speed of the fastest in the phase before, over thermal_speed()
  PhasePlan plan_;
  std::mutex meeting_;  ///< for mail and rest
  std::size_t resting_ = 0;
  int spins_;  ///< before a waiting thread yields
};

template <class Search, Effects effects>
ParallelLoop<Search, effects>::ParallelLoop(Run& run, const SearchSetup& setup, int threads,
                                            double sight, double least)
    : Base(run, setup),
      cells_(search_.grid().counts()),
      // Two needles that may meet before one of them is placed anew, with room for rounding.
      sight_of_done_(1.01 + 2 * search_.drift()),
      neighbours_(cells_within(search_.grid(), sight_of_done_)),
      reach_(search_.grid(), sight),
      claims_(cells_, neighbours_, static_cast<std::size_t>(threads)),
      done_(search_.grid(), run.gas.box),
      fronts_(static_cast<std::size_t>(threads), sight_of_done_),
      plan_(run.gas.clock, least) {
  int team = 0;
  omp_set_dynamic(0);  // all of them, in every phase
#pragma omp parallel num_threads(threads)
#pragma omp single
  team = omp_get_num_threads();
  if (team != threads) {
    throw InputError("engine.threads = " + std::to_string(threads) + ": expected at most " +
                     std::to_string(team) +
                     ", which is all that OpenMP gives here (OMP_THREAD_LIMIT, "
                     "OMP_MAX_ACTIVE_LEVELS, or a parallel region around)");
  }
  const CellCounts moves = cells_within(search_.grid(), search_.drift() + search_.radius());
  for (int axis = 0; axis < 3; ++axis) {
    apart_[axis] = 3 * neighbours_[axis] + 2 * moves[axis];
    if (cells_[axis] >= Claims::most_cells) {
      throw InputError("engine.threads = " + std::to_string(threads) +
                       ": expected 1 for a box of " + std::to_string(cells_[axis]) +
                       " cells along an edge");
    }
  }
  const auto x = static_cast<Block>(cells_[0]), y = static_cast<Block>(cells_[1]);
  for (Block b = 0; b < queue_.blocks(); ++b) {
    places_.push_back({static_cast<std::int32_t>(b % x), static_cast<std::int32_t>(b / x % y),
                       static_cast<std::int32_t>(b / x / y)});
  }
  for (int t = 0; t < threads; ++t) hands_.emplace_back(*this, static_cast<std::uint32_t>(t));
  double squares = 0;
  for (const Record& record : run.gas.records) {
    squares = std::max(squares, dot(record.flight.v, record.flight.v));
  }
  fastest_to_thermal_ = squares > 0 ? std::sqrt(squares) / thermal_speed() : 0;
  // With a core for each, most waits are shorter than a visit to the system.
  spins_ = threads <= omp_get_num_procs() ? 1000 : 32;
  divide();
}

template <class Search, Effects effects>
void ParallelLoop<Search, effects>::divide() {
  std::vector<std::size_t> weight(queue_.blocks());
  for (Block b = 0; b < queue_.blocks(); ++b) weight[b] = queue_.needles_in(b);
  const auto threads = static_cast<std::uint32_t>(hands_.size());
  const std::vector<std::uint32_t> zone = divide_box(cells_, run_.gas.box, weight, threads);
  queue_.divide(zone, threads);
  inner_ = inner_cells(cells_, zone, apart_);
  ours_ = inner_cells(cells_, zone, reach_.reach());
  for (Hand& hand : hands_) hand.worker.forget();
}

template <class Search, Effects effects>
std::optional<Stop> ParallelLoop<Search, effects>::advance(const Limits& limits) {
  const Time last =
      limits.time == Time::never()
          ? limits.time
          : Time{limits.time.epoch,
                 std::nextafter(limits.time.offset, std::numeric_limits<double>::infinity())};
  for (;;) {
    if (const auto stop = limits.reached(run_)) return stop;
    if (const auto stop = limits.called_off(run_)) return stop;
    if (run_.tally.collisions >= limits.pause) return std::nullopt;
    const Time next = queue_.top().time;
    if (this->pass_window(next, limits)) continue;
    if (next > limits.time) {
      run_.now = limits.time;
      return Stop::time;
    }
    if (next == Time::never()) return Stop::nothing_can_happen;
    // Till `ready` no thread finds that the search has to begin its times anew.
    const Time ready = search_.prepare(run_.now);
    const double left = std::ceil(limits.collisions) - static_cast<double>(run_.tally.collisions);
    const PhasePlan::Stretch stretch =
        plan_.next({next, std::min(run_.window_end, last), ready, left, thermal_rate()});
    const std::uint64_t before = run_.tally.collisions;
    if (stretch.together) {
      run_together(limits, stretch.end);
    } else {
      queue_.order_again();
      if (const auto stop = this->run_alone(limits, stretch.end)) return stop;
      if (run_.tally.collisions >= limits.pause) return std::nullopt;
    }
    plan_.counted(static_cast<double>(run_.tally.collisions - before),
                  thermal_rate() * run_.gas.clock.difference(stretch.end, next));
  }
}

// Runs events before `end` on all threads. Undoes all when that is not what one thread would have
// done, or when it would have stopped before; then one thread has to do it. Undoes all as well when
// there are many more collisions than expected; then threads try less at once.
template <class Search, Effects effects>
void ParallelLoop<Search, effects>::run_together(const Limits& limits, Time end) {
  done_.clear();
  amiss_ = too_many_ = finished_ = false;
  resting_ = 0;
  // The phase before may be long ago.
  fronts_.begin(fastest_to_thermal_ * thermal_speed());
  for (Hand& hand : hands_) {
    hand.undo.clear();
    hand.reports.clear();
    hand.worker.now = run_.now;
    hand.worker.reports = run_.callback ? &hand.reports : nullptr;
    hand.has_mail = hand.resting = false;
    hand.mail.clear();
    hand.held.clear();
  }
  [[maybe_unused]] const Time base = search_.hulls().base;
  const TimeKey end_key = queue_.key_of(end);
  const int threads = static_cast<int>(hands_.size());
#pragma omp parallel num_threads(threads)
  {
    if (omp_get_num_threads() == threads) {
      Hand& me = hands_[static_cast<std::size_t>(omp_get_thread_num())];
      try {
        work(me, end_key);
      } catch (...) {
        // Whatever it was, one thread will come to it, if it is so, with all that was before.
        amiss_ = true;
      }
      claims_.drop(me.zone);
    } else {
      amiss_ = true;
    }
  }
  assert(search_.hulls().base == base);  // which no thread may change for the others
  ++run_.tally.counters.phases;
  const double fastest = fronts_.fastest();
  fastest_to_thermal_ = fastest > 0 ? fastest / thermal_speed() : 0;
  const Tally before = run_.tally;
  for (Hand& hand : hands_) run_.tally.take(hand.tally);
  if (amiss_ || limits.reached(run_)) {
    const Counters counters = run_.tally.counters;
    run_.tally = before;
    run_.tally.counters = counters;
    ++run_.tally.counters.redone;
    undo();
    if (too_many_) {
      plan_.had_too_many();
    } else {
      plan_.undone(run_.now, end);
    }
    return;
  }
  plan_.kept();
  for (const Hand& hand : hands_) run_.now = std::max(run_.now, hand.worker.now);
  report();
}

template <class Search, Effects effects>
void ParallelLoop<Search, effects>::undo() {
  std::vector<Needle> needles;
  for (Hand& hand : hands_) {
    hand.undo.put_back(run_.gas, run_.last_collision);
    needles.insert(needles.end(), hand.undo.scheduled().begin(), hand.undo.scheduled().end());
    hand.worker.forget();
  }
  std::sort(needles.begin(), needles.end());
  needles.erase(std::unique(needles.begin(), needles.end()), needles.end());
  queue_.order_again();  // events that were held among them
  this->worker_.now = run_.now;
  this->worker_.forget();
  std::vector<Time> placed_until;
  for (const Needle i : needles) placed_until.push_back(search_.place(i, run_.now));
  for (std::size_t n = 0; n < needles.size(); ++n) {
    this->worker_.schedule(needles[n], placed_until[n]);
  }
}

// Reports the collisions of the phase in their order.
template <class Search, Effects effects>
void ParallelLoop<Search, effects>::report() {
  if (!run_.callback) return;
  std::vector<const Collision*> all;
  for (const Hand& hand : hands_) {
    for (const Collision& collision : hand.reports) all.push_back(&collision);
  }
  std::sort(all.begin(), all.end(), [](const Collision* a, const Collision* b) {
    const auto key = [](const Collision& c) {
      return std::tie(c.epoch, c.offset, c.first, c.second, c.shift);
    };
    return key(*a) < key(*b);
  });
  for (const Collision* collision : all) run_.callback(*collision);
}

template <class Search, Effects effects>
void ParallelLoop<Search, effects>::work(Hand& me, TimeKey end) {
  Patience patience(spins_);
  Blockings blockings;
  const auto go_on = [&] {
    patience.reset();
    blockings.end(me.tally.counters.turns, me.tally.counters.blocked);
  };
  const auto wait = [&] {
    blockings.begin();
    patience.wait();
  };
  while (!amiss_.load(std::memory_order_relaxed)) {
    if (me.has_mail.load(std::memory_order_acquire)) read_mail(me);
    release_held(me);
    const TimeKey key = queue_.winning_key(me.zone);
    TimeKey front = key;
    for (const Held& held : me.held) front = std::min(front, held.key);
    fronts_.tell_next(me.zone, front);
    // Those held may wait for one that has come up since.
    const bool may_start = me.held.size() < most_held || key == front;
    if (key < end && may_start && !fronts_.is_too_far_ahead(key)) {
      const Outcome outcome = attempt(me, queue_.winner(me.zone), key);
      if (outcome == Outcome::done) go_on();
      if (outcome == Outcome::again) wait();
      continue;
    }
    if (key >= end && me.held.empty()) {
      blockings.begin();
      if (rest(me)) break;
      continue;
    }
    ++me.tally.counters.waited;
    wait();
  }
  go_on();
}

// Does the next event of a block, unless it has to wait.
template <class Search, Effects effects>
auto ParallelLoop<Search, effects>::attempt(Hand& me, Block block, TimeKey key) -> Outcome {
  const bool alone = inner_[block] && me.held.empty();
  const auto give_up = [&](Block for_block) {
    claims_.drop(me.zone);
    return for_block == nobody ? Outcome::again : hold(me, block, key, for_block);
  };
  const auto claim = [&](Claims::Part part, const CellBox& box) {
    return alone || claims_.claim(me.zone, part, box);
  };
  if (!alone) {
    ++me.tally.counters.border;
    const Block earlier = earlier_around(me, block, block, key);
    if (earlier != nobody) return give_up(earlier);
    if (!claim(Claims::owner, cell_of(block))) return Outcome::again;
    // Somebody may have written to the block, or to others of the zone near it, just before.
    if (queue_.clock_of(block) != key || me.has_mail.load(std::memory_order_acquire)) {
      return give_up(nobody);
    }
  }
  const Event event = queue_.top_of(block);
  me.worker.bring_near(queue_.soon(me.zone));
  if (event.is_contact()) {
    queue_.bring_near(event.partner);
    me.worker.bring_near(event.partner);
  }
  queue_.bring_keys_near(block);
  bool stale = false, near_partner = false;
  if (event.is_contact()) {
    // A partner that is no longer near has had another collision.
    const Block other = queue_.block_of(event.partner);
    const CellBox here = cell_of(block), there = cell_of(other);
    near_partner = near(here, there, cells_, neighbours_);
    stale = !near_partner;
    if (near_partner) {
      if (!alone && other != block) {
        const Block earlier = earlier_around(me, other, block, key);
        if (earlier != nobody) return give_up(earlier);
      }
      if (!claim(Claims::partner, there)) return Outcome::again;
      if (queue_.block_of(event.partner) != other) return give_up(nobody);
      queue_.bring_keys_near(other);
      stale = me.worker.is_stale(event);
    }
  }
  const bool collides = event.is_contact() && !stale;
  const Done owner = take(event.owner, event, key);
  done_.bring_near(owner.r);
  if (!claim(Claims::owner, cells_of(event.owner, owner.r))) return Outcome::again;
  Done partner;
  if (collides) {
    partner = take(event.partner, event, key);
    done_.bring_near(partner.r);
    if (!claim(Claims::partner, cells_of(event.partner, partner.r))) return Outcome::again;
  } else if (stale && near_partner && run_.gas.records[event.partner].time > event.time) {
    // It may have happened, had it had its turn.
    amiss_ = true;
    return give_up(nobody);
  }
  const double fastest = collides ? std::max(owner.speed, partner.speed) : owner.speed;
  const bool in_order = fronts_.tell_taken(me.zone, key, fastest);
  me.queue.changed.clear();
#ifndef NDEBUG
  me.worker.read_ahead = false;
#endif
  me.worker.happen(event, stale);
  if (me.tally.collisions > plan_.most_of_a_thread()) too_many_ = amiss_ = true;
  const auto record = [&](Needle i, const Done& taken) {
    const Vec3d& v = run_.gas.records[i].flight.v;
    if (may_have_met(me, taken, std::sqrt(dot(v, v)), in_order, alone)) amiss_ = true;
    done_.add(taken);
  };
  record(event.owner, owner);
  if (collides) record(event.partner, partner);
  // No record that an event reads is ahead of it, or the phase is undone.
  assert(!me.worker.read_ahead || amiss_);
  make_known(me);
  if (!alone) claims_.drop(me.zone);
  return Outcome::done;
}

template <class Search, Effects effects>
auto ParallelLoop<Search, effects>::hold(Hand& me, Block block, TimeKey key, Block for_block)
    -> Outcome {
  ++me.tally.counters.held;
  me.held.push_back({block, for_block, key});
  queue_.follow_by_key(block, CellCalendar::no_event);
  return Outcome::held;
}

// Lets those go on whose turn may have come.
template <class Search, Effects effects>
void ParallelLoop<Search, effects>::release_held(Hand& me) {
  std::erase_if(me.held, [&](const Held& held) {
    look_away();
    const TimeKey clock = queue_.clock_of(held.for_block);
    if (clock < held.key || (clock == held.key && held.for_block < held.block)) return false;
    queue_.follow_by_key(held.block, queue_.clock_of(held.block));
    return true;
  });
}

template <class Search, Effects effects>
void ParallelLoop<Search, effects>::read_mail(Hand& me) {
  std::vector<Block> blocks;
  {
    const std::lock_guard alone(meeting_);
    blocks.swap(me.mail);
    me.has_mail.store(false, std::memory_order_relaxed);
  }
  for (const Block block : blocks) {
    std::erase_if(me.held, [&](const Held& held) { return held.block == block; });
    queue_.follow_by_key(block, queue_.clock_of(block));
  }
}

// Waits for mail; returns true when all threads do.
template <class Search, Effects effects>
bool ParallelLoop<Search, effects>::rest(Hand& me) {
  {
    const std::lock_guard alone(meeting_);
    if (!me.mail.empty()) return false;
    me.resting = true;
    if (++resting_ == hands_.size()) finished_ = true;
  }
  for (Patience patience(spins_); !finished_.load() && !amiss_.load(); patience.wait()) {
    if (me.has_mail.load(std::memory_order_acquire)) return false;
  }
  return true;
}

// Makes the clocks of the blocks that an event has changed known: first those that it has brought
// forward, so that nobody sees this one done and not what follows from it.
template <class Search, Effects effects>
void ParallelLoop<Search, effects>::make_known(Hand& me) {
  std::vector<Block>& changed = me.queue.changed;
  look_away();
  for (const Block b : changed) {
    if (queue_.key_of_next(b) < queue_.clock_of(b)) queue_.publish(b);
  }
  for (const Block b : changed) {
    look_away();
    queue_.publish(b);
    const std::uint32_t zone = queue_.zone_of(b);
    if (zone == me.zone) {
      std::erase_if(me.held, [&](const Held& held) { return held.block == b; });
      queue_.follow_by_key(b, queue_.clock_of(b));
      continue;
    }
    ++me.tally.counters.foreign;
    Hand& other = hands_[zone];
    const std::lock_guard alone(meeting_);
    other.mail.push_back(b);
    other.has_mail.store(true, std::memory_order_release);
    if (other.resting) {
      other.resting = false;
      --resting_;
    }
  }
}

// A block within reach of `centre` whose clock is behind the event of `block`, if any. Of the
// zone's own blocks these can only be held ones.
template <class Search, Effects effects>
auto ParallelLoop<Search, effects>::earlier_around(const Hand& me, Block centre, Block block,
                                                   TimeKey key) const -> Block {
  look_away();
  for (const Held& held : me.held) {
    const bool before = held.key < key || (held.key == key && held.block < block);
    if (before && reach_.holds(places_[centre], places_[held.block])) return held.block;
  }
  Block found = nobody;
  if (ours_[centre] && queue_.zone_of(centre) == me.zone) return found;
  reach_.any_row(places_[centre], [&](Block first, Block last) {
    // Zones are boxes.
    if (queue_.zone_of(first) == me.zone && queue_.zone_of(last - 1) == me.zone) return false;
    for (Block b = first; b < last; ++b) {
      const TimeKey clock = queue_.clock_of(b);
      if (clock > key || (clock == key && b >= block)) continue;
      found = b;
      return true;
    }
    return false;
  });
  return found;
}

template <class Search, Effects effects>
auto ParallelLoop<Search, effects>::take(Needle i, const Event& event, TimeKey key) const -> Done {
  const Record& record = run_.gas.records[i];
  const kernels::Flight& flight = record.flight;
  return {key,
          centre_after(flight, run_.gas.clock.difference(event.time, record.time)),
          std::sqrt(dot(flight.v, flight.v)),
          event.is_contact(),
          event.lower_id,
          event.higher_id,
          event.time};
}

// The cell of a needle that is at r, and those in which it may be placed.
template <class Search, Effects effects>
CellBox ParallelLoop<Search, effects>::cells_of(Needle i, const Vec3d& r) const {
  return cells_around(search_.grid(), r, search_.radius() * (1 + 0x1p-10) + 0x1p-20,
                      search_.cell_of(i));
}

// Whether a needle that has had an event, and is so fast since, may have met one whose later event
// has been done, before that. `in_order`: this thread has done none that is later. `alone`: others
// are far.
template <class Search, Effects effects>
bool ParallelLoop<Search, effects>::may_have_met(const Hand& me, const Done& mine, double speed,
                                                 bool in_order, bool alone) const {
  const double farthest = fronts_.reach_of_later(me.zone, mine.key, speed, in_order);
  if (farthest == 0) return false;
  if (fronts_.is_out_of_sight(farthest)) return true;
  return !(alone && in_order) && done_.may_have_met(mine, speed, farthest);
}

}  // namespace needlework
