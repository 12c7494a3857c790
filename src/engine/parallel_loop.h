// The event loop on several threads, with the same trajectory as on one.
//
// The box is divided into subdomains, one for each thread. A thread processes the events of the
// needles in its subdomain, the earliest first. An event reads and writes only within some cells of
// its place, so events that are far apart may be processed in any order, or at the same time. An
// event waits while a cell in sight has an earlier one; other events of the subdomain, far
// from the waiting ones, go on. A thread also waits while another thread is very far behind in
// time. Near other subdomains a thread locks the cells to which its event may write before it reads
// any.
//
// This is nearly always enough, but no such rule can be enough with certainty: a chain of
// collisions may propagate in almost no time, from an event out of sight to the place of one
// that has already been processed. So every event looks for later ones that have been processed
// near it. They do no harm if no needle of the one event can meet a needle of the other in
// between: then neither event affects the other before the later time, and the contacts after it
// have been searched with the new records of both. If they may meet, or if anything else has gone
// wrong, the whole phase, which is the time since the threads last met, is rolled back, and one
// thread processes it again. The counter `redone` counts such phases.
//
// A limit that stops the run at one collision is handled in the same way: a phase that passes it
// is rolled back, and one thread processes it again and stops there.
//
// subdomain_thread.h holds what one thread does in a phase, phase.h what all threads share.
#pragma once

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <deque>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/default_arithmetic.h"
#include "needlework/error.h"
#include "src/calendar/cell_calendar.h"
#include "src/engine/event_loop.h"
#include "src/engine/parallel_tuning.h"
#include "src/engine/phase.h"
#include "src/engine/phase_plan.h"
#include "src/engine/subdomain_thread.h"
#include "src/engine/team_choice.h"
#include "src/machine/available_cores.h"

namespace needlework {

/// Wall time since it was made [s].
class WallTime {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
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

/// Whether OpenMP has threads for this process. In a child that was forked after they were made, it
/// would wait for them without end.
inline bool has_threads() {
  static const pid_t first = getpid();
  return getpid() == first;
}

/// How many threads there are when so many are asked for.
inline int team_of(int threads) {
  const WholeTeams whole;
  int team = 0;
#pragma omp parallel num_threads(threads)
#pragma omp single
  team = omp_get_num_threads();
  return team;
}

/// More threads than cores only wait for each other.
inline int subdomains_for(int threads, const ParallelTuning& tuning) {
  return tuning.by_cost ? std::min(threads, available_cores().usable()) : threads;
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

  std::optional<Stop> advance(const StopConditions& limits) override;
  void begin_again(ReplacedRecords&& replaced) override;

 private:
  std::size_t search_from(std::size_t first) override;
  void find_together(std::size_t first);
  void prepared() override {
    if (phase_.inner.empty()) divide();
  }
  void divide();
  void note_fastest();
  void sort_storage() override {
    Base::sort_storage();
    divide();
  }
  void run_together(const StopConditions& limits, Time end);
  void roll_back();
  void report();

  /// Whether the next event is at a time, as far as keys can tell.
  bool is_next_at(Time time) const {
    return cell_calendar_.key_of(cell_calendar_.top().time) == cell_calendar_.key_of(time);
  }
  /// Makes the calendar fit for one thread.
  void put_in_order() {
    if (!ordered_) cell_calendar_.order_again();
    ordered_ = true;
  }

  static constexpr TeamChoice::Turn all_together{true, std::numeric_limits<double>::infinity()};

  /// Collisions of the whole gas per time, from the mean free time.
  double thermal_rate() const {
    return 0.5 * static_cast<double>(run_.gas.size()) / run_.windows.mean_free_time();
  }
  /// Whether keys, which are times since the start as doubles, have enough digits for the events of
  /// one window. In a gas that does not cool they lose them after some 2^30 mean free times.
  /// Threads compare nothing but keys, and could wait for each other without end.
  bool keys_resolve(Time now) const {
    return run_.gas.clock.since_start(now) * 0x1p-30 <= run_.windows.search_span();
  }
  double thermal_speed() const { return std::sqrt(std::max(0.0, run_.present_energy())); }

  CellCalendar& cell_calendar_;
  Phase<S> phase_;
  std::deque<SubdomainThread<S, M>> threads_;
  double fastest_to_thermal_;  ///< speed of the fastest needle of the previous phase, divided by
                               ///< thermal_speed()
  PhasePlan plan_;
  TeamChoice team_, searching_team_;
  const bool by_cost_;
  std::vector<std::optional<Event>> found_;  ///< by threads that search together
  bool ordered_ = true;  ///< whether one thread alone can use the calendar as it is
};

template <Search S, Model M>
ParallelLoop<S, M>::ParallelLoop(Run& run, S search, ReplacedRecords replaced, int threads,
                                 const ParallelTuning& tuning)
    : Base(run, std::move(search), std::make_unique<CalendarOf<CellCalendar>>(),
           std::move(replaced)),
      cell_calendar_(static_cast<CalendarOf<CellCalendar>&>(*this->calendar_).get()),
      phase_(run, search_, cell_calendar_, subdomains_for(threads, tuning), tuning.sight,
             tuning.place),
      plan_(run.gas.clock, PhasePlan::usual_share * phase_.threads, tuning.least),
      by_cost_(tuning.by_cost) {
  const int team = has_threads() ? team_of(threads) : threads;
  if (team != threads) {
    throw InputError(std::string(tuning.place) + ": expected at most " + std::to_string(team) +
                     ", which is all that OpenMP gives here (OMP_THREAD_LIMIT, "
                     "OMP_MAX_ACTIVE_LEVELS, or a parallel region around)");
  }
  for (std::uint32_t subdomain = 0; subdomain < phase_.threads; ++subdomain)
    threads_.emplace_back(phase_, this->model_, subdomain);
  phase_.may_be_too_slow = tuning.by_cost;
  note_fastest();
}

template <Search S, Model M>
void ParallelLoop<S, M>::note_fastest() {
  double fastest = 0;
  for (const Record& record : run_.gas.records) {
    fastest = std::max(fastest, run_.gas.fastest_of(record));
  }
  fastest_to_thermal_ = fastest > 0 ? fastest / thermal_speed() : 0;
}

template <Search S, Model M>
void ParallelLoop<S, M>::begin_again(ReplacedRecords&& replaced) {
  put_in_order();
  phase_.causality_log.clear();
  for (auto& thread : threads_) thread.forget();
  note_fastest();
  Base::begin_again(std::move(replaced));
}

// All threads share the searches where that is faster. What they find is entered afterwards: a
// search reads what others have found, but what follows from all events does not depend on that.
template <Search S, Model M>
std::size_t ParallelLoop<S, M>::search_from(std::size_t first) {
  // So many that threads wait little for the last one, and few that a run of a dense gas, in which
  // a search takes a millisecond, is soon called off.
  constexpr std::size_t most = 512;
  const std::size_t count = std::min(most, run_.gas.size() - first);
  const TeamChoice::Turn turn = by_cost_ ? searching_team_.next() : all_together;
  const bool together = turn.together && threads_.size() > 1 && has_threads();
  const WallTime time;
  found_.assign(count, std::nullopt);
  if (together) find_together(first);
  for (std::size_t n = 0; n < count; ++n) {
    if (found_[n]) {
      processor_.enter_found(*found_[n]);
    } else {
      this->first_search(Needle(first + n));
    }
  }
  searching_team_.took(together, static_cast<double>(count), time.seconds());
  return first + count;
}

// Needles that touch are left out, which one thread has to do.
template <Search S, Model M>
void ParallelLoop<S, M>::find_together(std::size_t first) {
  constexpr std::size_t share = 8;
  std::atomic<std::size_t> next = 0;
  const WholeTeams whole;
#pragma omp parallel num_threads(static_cast <int>(threads_.size()))
  {
    const kernels::DefaultArithmetic arithmetic;
    auto& thread = threads_[static_cast<std::size_t>(omp_get_thread_num())];
    thread.begin_searches();
    for (std::size_t begin; (begin = next.fetch_add(share)) < found_.size();) {
      const std::size_t end = std::min(begin + share, found_.size());
      for (std::size_t n = begin; n < end; ++n) {
        const Needle i(first + n);
        if (!this->is_to_be_renewed(i)) found_[n] = thread.find(i, this->placed_until_[i]);
      }
    }
  }
  for (auto& thread : threads_) run_.tally.take(thread.tally());
}

template <Search S, Model M>
void ParallelLoop<S, M>::divide() {
  phase_.divide();
  ordered_ = true;
  for (auto& thread : threads_) thread.forget();
}

template <Search S, Model M>
std::optional<Stop> ParallelLoop<S, M>::advance(const StopConditions& limits) {
  if (const auto stop = this->prepare(&limits)) return stop;
  const Time last =
      limits.time == Time::never()
          ? limits.time
          : Time{limits.time.epoch,
                 std::nextafter(limits.time.offset, std::numeric_limits<double>::infinity())};
  for (;;) {
    if (const auto stop = limits.reached(run_)) return stop;
    if (const auto stop = limits.called_off(run_)) return stop;
    if (run_.tally.collisions >= limits.pause) return std::nullopt;
    // Threads order events by keys only, so that of several at the end of a window, or of the run,
    // a later one might be on top.
    if (is_next_at(run_.windows.end()) || is_next_at(limits.time)) put_in_order();
    const Time next = cell_calendar_.top().time;
    if (this->pass_window(next, limits)) continue;
    if (next > limits.time) {
      run_.now = limits.time;
      return Stop::time;
    }
    if (next == Time::never()) return run_.end_of_events();
    // Before `ready` no thread has to rebase the times that the search stores.
    const Time ready = search_.prepare(run_.now, run_.team.threads());
    const double left = std::ceil(limits.collisions) - static_cast<double>(run_.tally.collisions);
    const TeamChoice::Turn turn = by_cost_ ? team_.next() : all_together;
    const PhasePlan::Stretch stretch = plan_.next({next, std::min(run_.windows.end(), last), ready,
                                                   left, thermal_rate(), turn.together, turn.most});
    const std::uint64_t before = run_.tally.collisions;
    const bool together =
        stretch.together && has_threads() && keys_resolve(next) &&
        cell_calendar_.key_of(next) < cell_calendar_.key_of(stretch.end);  // else nobody works
    const WallTime time;
    double preparing = 0;
    std::optional<Stop> stop;
    if (together) {
      run_together(limits, stretch.end);
    } else {
      run_.team.set(1);
      put_in_order();
      preparing = time.seconds();
      stop = this->run_alone(limits, stretch.end);
    }
    const auto collisions = static_cast<double>(run_.tally.collisions - before);
    if (!together) run_.tally.counters.alone += run_.tally.collisions - before;
    team_.took(together, collisions, time.seconds() - preparing, preparing);
    if (stop) return stop;
    if (!together && run_.tally.collisions >= limits.pause) return std::nullopt;
    plan_.counted(collisions, thermal_rate() * run_.gas.clock.difference(stretch.end, next));
  }
}

// Processes events before `end` on all threads. If the result may differ from that of one thread,
// or if one thread would have stopped earlier, rolls back the phase and leaves it to one thread. If
// there are many more collisions than expected, rolls it back and makes the next phases shorter.
template <Search S, Model M>
void ParallelLoop<S, M>::run_together(const StopConditions& limits, Time end) {
  // The previous phase may have been long ago, so its largest speed is rescaled.
  phase_.begin(fastest_to_thermal_ * thermal_speed(), plan_.most_of_a_thread());
  for (auto& thread : threads_) thread.begin();
  [[maybe_unused]] const Time base = search_.volumes().frame.base;
  const TimeKey end_key = cell_calendar_.key_of(end);
  assert(phase_.causality_log.is_before(cell_calendar_.key_of(cell_calendar_.top().time)));
  ordered_ = false;
  const int threads = static_cast<int>(threads_.size());
  {
    const WholeTeams whole;
#pragma omp parallel num_threads(threads)
    {
      if (omp_get_num_threads() == threads) {
        // OpenMP's threads may have been made by a host program, with its choice of arithmetic.
        const kernels::DefaultArithmetic arithmetic;
        const auto subdomain = static_cast<std::uint32_t>(omp_get_thread_num());
        try {
          threads_[subdomain].work(end_key);
        } catch (...) {
          // If the error is real, the thread that repeats the phase meets it too, after all earlier
          // events.
          phase_.must_roll_back = true;
        }
        phase_.region_locks.release(subdomain);
      } else {
        phase_.must_roll_back = true;
      }
    }
  }
  assert(search_.volumes().frame.base == base);  // no thread may rebase while others work
  ++run_.tally.counters.phases;
  const double fastest = phase_.local_times.fastest();
  fastest_to_thermal_ = fastest > 0 ? fastest / thermal_speed() : 0;
  const Tally before = run_.tally;
  for (auto& thread : threads_) run_.tally.take(thread.tally());
  const bool redo = phase_.must_roll_back || limits.reached(run_);
  run_.team.set(redo ? 1 : threads);
  if (redo) {
    const Counters counters = run_.tally.counters;
    run_.tally = before;
    run_.tally.counters = counters;
    ++run_.tally.counters.redone;
    roll_back();
    if (phase_.too_many) {
      plan_.had_too_many(run_.now, end);
    } else if (!phase_.too_slow) {
      plan_.rolled_back(run_.now, end);
    }
    return;
  }
  plan_.kept();
  for (const auto& thread : threads_) run_.now = std::max(run_.now, thread.latest());
  report();
}

template <Search S, Model M>
void ParallelLoop<S, M>::roll_back() {
  std::vector<Needle> needles;
  for (auto& thread : threads_) thread.roll_back(needles);
  phase_.causality_log.clear();  // the same times come again
  std::sort(needles.begin(), needles.end());
  needles.erase(std::unique(needles.begin(), needles.end()), needles.end());
  cell_calendar_.order_again();  // they may include deferred events
  processor_.set_now(run_.now);
  processor_.forget();
  std::vector<Time> placed_until;
  for (const Needle i : needles) placed_until.push_back(processor_.place(i));
  for (std::size_t n = 0; n < needles.size(); ++n) {
    processor_.schedule(needles[n], placed_until[n]);
  }
  ordered_ = true;
}

// Reports what has happened in the phase, whole happenings in order of time.
template <Search S, Model M>
void ParallelLoop<S, M>::report() {
  if (run_.listeners.times) {
    for (const auto& thread : threads_) run_.listeners.times(thread.times());
  }
  if (!run_.listeners.want_happenings()) return;
  std::vector<const Happening*> all, before;
  for (const auto& thread : threads_) {
    before.swap(all);
    all.clear();
    std::merge(before.begin(), before.end(), thread.reports().begin(), thread.reports().end(),
               std::back_inserter(all), comes_before);
  }
  for (const Happening* happening : all) run_.listeners.pass_on(*happening);
}

}  // namespace needlework
