// The event loop of one thread: processes the earliest event, again and again, until a limit is
// met.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "src/calendar/any_calendar.h"
#include "src/engine/event_processor.h"
#include "src/engine/loop.h"
#include "src/engine/space_order.h"
#include "src/search/search.h"
#include "src/search/setup.h"

namespace needlework {

/// The loop of one thread, for any calendar. Search and model are compiled in.
template <Search S, Model M>
class EventLoop : public Loop {
 public:
  /// `run` must outlive the loop. `replaced` holds the previous state of records that were
  /// replaced at the present time.
  EventLoop(Run& run, S search, std::unique_ptr<AnyCalendar> calendar, ReplacedRecords replaced);

  std::optional<Stop> prepare(const StopConditions* limits) final;
  void keep_in_order() final {
    if (run_.is_out_of_order()) sort_storage();
  }
  void begin_again(ReplacedRecords&& replaced) override;
  std::optional<Stop> advance(const StopConditions& limits) override;
  const char* search_name() const override { return search_.name(); }
  const char* calendar_name() const override { return calendar_->name(); }

 protected:
  /// All needles have searched.
  virtual void prepared() {}
  /// Lets some needles search their first events, from this one on. Returns the first that has not.
  virtual std::size_t search_from(std::size_t first);
  /// If the window ends before `next`, the time of the next event, opens the next window and
  /// returns true.
  bool pass_window(Time next, const StopConditions& limits);
  /// Processes events before `end` until a limit is met. Returns nothing when it gets to `end` or
  /// to a pause without meeting one.
  std::optional<Stop> run_alone(const StopConditions& limits, Time end);
  virtual void sort_storage();

  Run& run_;
  M model_;
  S search_;
  std::unique_ptr<AnyCalendar> calendar_;
  EventProcessor<S, M> processor_;

  /// Time passes without events where nothing can happen, and a record may be older than it should
  /// become. From there, a search would look for contacts in the past, so that the record is
  /// renewed first.
  bool is_to_be_renewed(Needle i) const { return run_.gas.records[i].renewal < run_.now; }
  void first_search(Needle i);

  /// Of the needles that have been placed, until all have searched.
  std::vector<Time> placed_until_;

 private:
  /// Needles that search before anybody asks whether the run is called off.
  static constexpr std::size_t at_once = 16;

  bool is_prepared_ = false;
  std::size_t searched_ = 0;  ///< so many needles have searched, if not all have
};

template <Search S, Model M>
EventLoop<S, M>::EventLoop(Run& run, S search, std::unique_ptr<AnyCalendar> calendar,
                           ReplacedRecords replaced)
    : run_(run),
      model_(run.gas, run.effects, run.accuracy),
      search_(std::move(search)),
      calendar_(std::move(calendar)),
      processor_(run, model_, search_, *calendar_, run.tally) {
  const std::size_t count = run.gas.size();
  calendar_->reset(count, run.gas.clock, search_.cells());
  processor_.set_now(run.now);
  processor_.take(std::move(replaced));
  placed_until_.reserve(count);
}

// The events that are in the calendar are replaced one by one, as all needles search.
template <Search S, Model M>
void EventLoop<S, M>::begin_again(ReplacedRecords&& replaced) {
  placed_until_.reserve(run_.gas.size());  // first, as memory may run out
  placed_until_.clear();
  processor_.set_now(run_.now);
  processor_.forget();
  processor_.take(std::move(replaced));
  search_.begin_again(run_.now);
  is_prepared_ = false;
  searched_ = 0;
}

template <Search S, Model M>
std::optional<Stop> EventLoop<S, M>::prepare(const StopConditions* limits) {
  if (is_prepared_) return std::nullopt;
  const std::size_t count = run_.gas.size();
  const auto called_off = [&]() -> std::optional<Stop> {
    return limits ? limits->called_off(run_) : std::nullopt;
  };
  for (std::size_t i = placed_until_.size(); i < count; ++i) {
    if (i % at_once == 0) {
      if (const auto stop = called_off()) return stop;
    }
    placed_until_.push_back(processor_.place(Needle(i)));
  }
  while (searched_ < count) {
    if (const auto stop = called_off()) return stop;
    searched_ = search_from(searched_);
  }
  placed_until_ = {};
  prepared();
  is_prepared_ = true;
  return std::nullopt;
}

template <Search S, Model M>
std::size_t EventLoop<S, M>::search_from(std::size_t first) {
  const std::size_t end = std::min(first + at_once, run_.gas.size());
  for (std::size_t i = first; i < end; ++i) first_search(Needle(i));
  return end;
}

template <Search S, Model M>
void EventLoop<S, M>::first_search(Needle i) {
  if (!is_to_be_renewed(i)) return processor_.schedule(i, placed_until_[i]);
  Event event;
  event.owner = i;
  event.lower_id = event.higher_id = run_.gas.ids[i];
  event.time = run_.now;
  search_.set_next_event(i, run_.now);
  processor_.enter(event);
}

template <Search S, Model M>
std::optional<Stop> EventLoop<S, M>::advance(const StopConditions& limits) {
  if (const auto stop = prepare(&limits)) return stop;
  return run_alone(limits, Time::never());
}

template <Search S, Model M>
std::optional<Stop> EventLoop<S, M>::run_alone(const StopConditions& limits, Time end) {
  for (;;) {
    if (const auto stop = limits.reached(run_)) return stop;
    // Looking at the clock costs more than looking at a flag.
    if (run_.interrupted || run_.tally.counters.events % 256 == 0) {
      if (const auto stop = limits.called_off(run_)) return stop;
      if (run_.tally.collisions >= limits.pause) return std::nullopt;
    }
    const Event event = calendar_->top();
    processor_.prefetch(event.owner);
    const Event& likely_next = calendar_->of(calendar_->likely_next());
    processor_.prefetch(likely_next.owner);
    if (likely_next.has_partner()) processor_.prefetch(likely_next.partner);
    if (pass_window(event.time, limits)) continue;
    if (event.time > limits.time) {
      run_.now = limits.time;
      return Stop::time;
    }
    if (event.time >= end) {
      if (event.time == Time::never()) return run_.end_of_events();
      return std::nullopt;
    }
    processor_.process(event, processor_.is_stale(event));
    run_.now = event.time;
  }
}

template <Search S, Model M>
bool EventLoop<S, M>::pass_window(Time next, const StopConditions& limits) {
  const Time until = std::min(next, limits.time);
  if (run_.windows.end() > until || until == Time::never()) return false;
  run_.now = run_.windows.end();
  run_.pass_window();
  FurtherTouches& touches = *run_.gas.further_touches;
  // No record of an earlier window is ever put back.
  if (touches.records() > 0) touches.keep_only(run_.gas.records, run_.gas.ids);
  if (run_.gas.slides) run_.gas.slides->keep_only(run_.gas.records, run_.gas.ids);
  keep_in_order();
  return true;
}

// Sorts the needles so that neighbours in space are neighbours in memory, once many have moved.
template <Search S, Model M>
void EventLoop<S, M>::sort_storage() {
  Gas& gas = run_.gas;
  const std::vector<Needle> order = run_.sort_storage(), ranks = ranks_of(order);
  search_.renumber(ranks);
  processor_.forget();
  std::vector<Event> events;
  events.reserve(gas.size());
  for (const Needle i : order) {
    Event& event = events.emplace_back(calendar_->of(i));
    event.owner = ranks[event.owner];
    if (event.partner != no_needle) event.partner = ranks[event.partner];
  }
  calendar_->reset(gas.size(), gas.clock, search_.cells());
  for (const Event& event : events) processor_.enter(event);
}

}  // namespace needlework
