// The event loop on several threads, with the trajectory of one.
//
// Each thread has a zone of the box and makes the events of the needles there happen, the earliest
// first. What an event reads and writes lies within some cells of it, so events far from each other
// may happen in any order, or at once. An event waits while the clock of any block within reach
// is behind it; other events of the zone, far from the waiting ones, go on. A thread waits as
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
//
// What a thread does is in zone_thread.h, what all of them share in phase.h.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <limits>
#include <string>
#include <tuple>

#include "needlework/error.h"
#include "src/calendar/cell_calendar.h"
#include "src/engine/event_loop.h"
#include "src/engine/phase.h"
#include "src/engine/phase_plan.h"
#include "src/engine/zone_thread.h"

namespace needlework {

/// How far threads look and how much work they share; other values are for tests.
struct ParallelTuning {
  /// How far from its cell an event looks for earlier ones. Where it is shorter, phases are undone
  /// again and again; longer, events wait without need. [L]
  double sight = 1.5;
  double least = PhasePlan::usual_least;  ///< collisions that make a phase worth sharing
};

/// Asks OpenMP for whole teams, and leaves its setting as found.
class WholeTeams {
 public:
  WholeTeams() : dynamic_(omp_get_dynamic()) { omp_set_dynamic(0); }
  ~WholeTeams() { omp_set_dynamic(dynamic_); }
  WholeTeams(const WholeTeams&) = delete;
  WholeTeams& operator=(const WholeTeams&) = delete;

 private:
  int dynamic_;
};

/// How many threads there are when so many are asked for.
inline int team_of(int threads) {
  const WholeTeams whole;
  int team = 0;
#pragma omp parallel num_threads(threads)
#pragma omp single
  team = omp_get_num_threads();
  return team;
}

template <Search S, Model M>
class ParallelLoop final : public EventLoop<S, M> {
  using Base = EventLoop<S, M>;
  using Base::processor_;
  using Base::run_;
  using Base::search_;

 public:
  ParallelLoop(Run& run, S search, ReplacedRecords replaced, int threads,
               const ParallelTuning& tuning);

  std::optional<Stop> advance(const Limits& limits) override;

 private:
  void divide();
  void sort_storage() override {
    Base::sort_storage();
    divide();
  }
  void run_together(const Limits& limits, Time end);
  void undo();
  void report();

  /// Collisions in a time, by the mean free time.
  double thermal_rate() const {
    return 0.5 * static_cast<double>(run_.gas.size()) / run_.mean_free_time;
  }
  double thermal_speed() const { return std::sqrt(std::max(0.0, run_.energy())); }

  CellCalendar& cell_calendar_;
  Phase<S> phase_;
  std::deque<ZoneThread<S, M>> threads_;
  double fastest_to_thermal_;  ///< speed of the fastest in the phase before, over thermal_speed()
  PhasePlan plan_;
};

template <Search S, Model M>
ParallelLoop<S, M>::ParallelLoop(Run& run, S search, ReplacedRecords replaced, int threads,
                                 const ParallelTuning& tuning)
    : Base(run, std::move(search), std::make_unique<CalendarOf<CellCalendar>>(),
           std::move(replaced)),
      cell_calendar_(static_cast<CalendarOf<CellCalendar>&>(*this->calendar_).get()),
      phase_(run, search_, cell_calendar_, threads, tuning.sight),
      plan_(run.gas.clock, tuning.least) {
  const int team = team_of(threads);
  if (team != threads) {
    throw InputError("engine.threads = " + std::to_string(threads) + ": expected at most " +
                     std::to_string(team) +
                     ", which is all that OpenMP gives here (OMP_THREAD_LIMIT, "
                     "OMP_MAX_ACTIVE_LEVELS, or a parallel region around)");
  }
  for (std::uint32_t zone = 0; zone < phase_.threads; ++zone)
    threads_.emplace_back(phase_, this->model_, zone);
  double squares = 0;
  for (const Record& record : run.gas.records) {
    squares = std::max(squares, dot(record.flight.v, record.flight.v));
  }
  fastest_to_thermal_ = squares > 0 ? std::sqrt(squares) / thermal_speed() : 0;
  divide();
}

template <Search S, Model M>
void ParallelLoop<S, M>::divide() {
  phase_.divide();
  for (auto& thread : threads_) thread.forget();
}

template <Search S, Model M>
std::optional<Stop> ParallelLoop<S, M>::advance(const Limits& limits) {
  const Time last =
      limits.time == Time::never()
          ? limits.time
          : Time{limits.time.epoch,
                 std::nextafter(limits.time.offset, std::numeric_limits<double>::infinity())};
  for (;;) {
    if (const auto stop = limits.reached(run_)) return stop;
    if (const auto stop = limits.called_off(run_)) return stop;
    if (run_.tally.collisions >= limits.pause) return std::nullopt;
    const Time next = cell_calendar_.top().time;
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
      cell_calendar_.order_again();
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
template <Search S, Model M>
void ParallelLoop<S, M>::run_together(const Limits& limits, Time end) {
  // The phase before may be long ago.
  phase_.begin(fastest_to_thermal_ * thermal_speed(), plan_.most_of_a_thread());
  for (auto& thread : threads_) thread.begin();
  [[maybe_unused]] const Time base = search_.volumes().base;
  const TimeKey end_key = cell_calendar_.key_of(end);
  const int threads = static_cast<int>(threads_.size());
  {
    const WholeTeams whole;
#pragma omp parallel num_threads(threads)
    {
      if (omp_get_num_threads() == threads) {
        const auto zone = static_cast<std::uint32_t>(omp_get_thread_num());
        try {
          threads_[zone].work(end_key);
        } catch (...) {
          // Whatever it was, one thread will come to it, if it is so, with all that was before.
          phase_.amiss = true;
        }
        phase_.claims.drop(zone);
      } else {
        phase_.amiss = true;
      }
    }
  }
  assert(search_.volumes().base == base);  // which no thread may change for the others
  ++run_.tally.counters.phases;
  const double fastest = phase_.fronts.fastest();
  fastest_to_thermal_ = fastest > 0 ? fastest / thermal_speed() : 0;
  const Tally before = run_.tally;
  for (auto& thread : threads_) run_.tally.take(thread.tally());
  if (phase_.amiss || limits.reached(run_)) {
    const Counters counters = run_.tally.counters;
    run_.tally = before;
    run_.tally.counters = counters;
    ++run_.tally.counters.redone;
    undo();
    if (phase_.too_many) {
      plan_.had_too_many();
    } else {
      plan_.undone(run_.now, end);
    }
    return;
  }
  plan_.kept();
  for (const auto& thread : threads_) run_.now = std::max(run_.now, thread.now());
  report();
}

template <Search S, Model M>
void ParallelLoop<S, M>::undo() {
  std::vector<Needle> needles;
  for (auto& thread : threads_) thread.undo(needles);
  std::sort(needles.begin(), needles.end());
  needles.erase(std::unique(needles.begin(), needles.end()), needles.end());
  cell_calendar_.order_again();  // events that were held among them
  processor_.set_now(run_.now);
  processor_.forget();
  std::vector<Time> placed_until;
  for (const Needle i : needles) placed_until.push_back(search_.place(i, run_.now));
  for (std::size_t n = 0; n < needles.size(); ++n) {
    processor_.schedule(needles[n], placed_until[n]);
  }
}

// Reports the collisions of the phase in their order.
template <Search S, Model M>
void ParallelLoop<S, M>::report() {
  if (!run_.callback) return;
  std::vector<const Collision*> all;
  for (const auto& thread : threads_) {
    for (const Collision& collision : thread.reports()) all.push_back(&collision);
  }
  std::sort(all.begin(), all.end(), [](const Collision* a, const Collision* b) {
    const auto key = [](const Collision& c) {
      return std::tie(c.epoch, c.offset, c.first, c.second, c.shift);
    };
    return key(*a) < key(*b);
  });
  for (const Collision* collision : all) run_.callback(*collision);
}

}  // namespace needlework
