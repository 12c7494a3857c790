// The event loop: takes the earliest event, makes it happen, and so on until the end.
#pragma once

#include <optional>
#include <vector>

#include "src/engine/loop.h"
#include "src/engine/space_order.h"
#include "src/engine/worker.h"
#include "src/search/setup.h"

namespace needlework {

template <class Search, class Queue, Effects effects>
class EventLoop : public Loop {
 public:
  /// `run` must outlive the loop.
  EventLoop(Run& run, const SearchSetup& setup);

  std::optional<Stop> advance(const Limits& limits) override;
  const char* search_name() const override { return Search::name; }
  const char* queue_name() const override { return Queue::name; }

 protected:
  /// Whether the window ends before an event at this time; then goes on to the next window.
  bool pass_window(Time next, const Limits& limits);
  /// Runs events before `end` until a limit is met; without a value at `end` or at a pause.
  std::optional<Stop> run_alone(const Limits& limits, Time end);
  virtual void sort_storage();

  Run& run_;
  Search search_;
  Queue queue_;
  Worker<Search, Queue, effects> worker_;
  std::uint64_t sorted_at_;  ///< crossings when the needles were last sorted

 private:
  static Queue make_queue(const Gas& gas, const Search& search) {
    if constexpr (requires { Queue(gas.size(), gas.clock, search.grid().size()); }) {
      return Queue(gas.size(), gas.clock, search.grid().size());
    } else {
      return Queue(gas.size(), gas.clock);
    }
  }
};

template <class Search, class Queue, Effects effects>
EventLoop<Search, Queue, effects>::EventLoop(Run& run, const SearchSetup& setup)
    : run_(run),
      search_(run.gas, run.tally.counters, setup),
      queue_(make_queue(run.gas, search_)),
      worker_(run, search_, queue_, run.tally),
      sorted_at_(run.tally.counters.crossings) {
  if constexpr (effects.contact_time) {
    // Unless a loop before has filled it in.
    run.last_collision.resize(run.gas.size(), Time{-(std::int64_t{1} << 62), 0});
  }
  worker_.now = run.now;
  const Needle count = static_cast<Needle>(run.gas.size());
  std::vector<Time> placed_until(count);
  for (Needle i = 0; i < count; ++i) placed_until[i] = search_.place(i, run.now);
  for (Needle i = 0; i < count; ++i) worker_.schedule(i, placed_until[i]);
}

template <class Search, class Queue, Effects effects>
std::optional<Stop> EventLoop<Search, Queue, effects>::advance(const Limits& limits) {
  return run_alone(limits, Time::never());
}

template <class Search, class Queue, Effects effects>
std::optional<Stop> EventLoop<Search, Queue, effects>::run_alone(const Limits& limits, Time end) {
  for (;;) {
    if (const auto stop = limits.reached(run_)) return stop;
    if (run_.tally.counters.events % 256 == 0) {
      if (const auto stop = limits.called_off(run_)) return stop;
      if (run_.tally.collisions >= limits.pause) return std::nullopt;
    }
    const Event event = queue_.top();
    worker_.bring_near(event.owner);
    if constexpr (requires { queue_.soon(); }) worker_.bring_near(queue_.soon());
    if (pass_window(event.time, limits)) continue;
    if (event.time > limits.time) {
      run_.now = limits.time;
      return Stop::time;
    }
    if (event.time >= end) {
      if (event.time == Time::never()) return Stop::nothing_can_happen;
      return std::nullopt;
    }
    worker_.happen(event, worker_.is_stale(event));
    run_.now = event.time;
  }
}

template <class Search, class Queue, Effects effects>
bool EventLoop<Search, Queue, effects>::pass_window(Time next, const Limits& limits) {
  const Time until = std::min(next, limits.time);
  if (run_.window_end > until || until == Time::never()) return false;
  run_.now = run_.window_end;
  run_.open_window();
  // Measured: after 2 to 8 of each needle the order is about as good, but sorting costs.
  constexpr std::uint64_t crossings = 6;
  const std::uint64_t crossed = run_.tally.counters.crossings - sorted_at_;
  if (run_.sorted && crossed > crossings * run_.gas.size()) sort_storage();
  return true;
}

// Stores neighbours in space next to each other again, once many have moved on.
template <class Search, class Queue, Effects effects>
void EventLoop<Search, Queue, effects>::sort_storage() {
  Gas& gas = run_.gas;
  ++run_.tally.counters.sorts;
  sorted_at_ = run_.tally.counters.crossings;
  const std::vector<Needle> order = order_in_space(gas, run_.now), ranks = ranks_of(order);
  reorder(gas, order);
  search_.renumber(ranks);
  if constexpr (effects.contact_time) permute(run_.last_collision, order);
  worker_.forget();
  std::vector<Event> events;
  events.reserve(gas.size());
  for (const Needle i : order) {
    Event& event = events.emplace_back(queue_.of(i));
    event.owner = ranks[event.owner];
    if (event.is_contact()) event.partner = ranks[event.partner];
  }
  queue_ = Queue(0, gas.clock);  // frees its memory
  queue_ = make_queue(gas, search_);
  for (const Event& event : events) worker_.enter(event);
}

}  // namespace needlework
