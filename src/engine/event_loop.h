// The event loop: takes the earliest event, makes it happen, and so on until the end.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "src/engine/space_order.h"
#include "src/engine/worker.h"
#include "src/search/setup.h"

namespace needlework {

template <class Search, class Queue, Effects effects>
class EventLoop : public Run {
 public:
  EventLoop(const Scene& scene, Gas initial, const SearchSetup& setup);

  Stop advance(const Scene::Until& until) override;
  const char* search_name() const override { return Search::name; }
  const char* queue_name() const override { return Queue::name; }

 protected:
  /// Ends of a call of advance().
  struct Limits {
    Limits(const Run& run, const Scene::Until& until);

    Time time;  ///< never: none
    double collisions;
    double energy;
    std::chrono::steady_clock::time_point wall;
  };

  /// Brings a run that is at its end, or in which nothing can happen, there.
  std::optional<Stop> needs_no_events(const Limits& limits);
  /// The limit that has been met, of those of the state.
  std::optional<Stop> reached(const Limits& limits) const;
  /// The limit that has been met, of those from outside.
  std::optional<Stop> called_off(const Limits& limits) const;
  /// Whether the window ends before an event at this time; then goes on to the next window.
  bool pass_window(Time next, const Limits& limits);
  /// Runs events before `end` until a limit is met; without a value when that came first.
  std::optional<Stop> run_alone(const Limits& limits, Time end);
  virtual void sort_storage();

  Search search_;
  Queue queue_;
  Worker<Search, Queue, effects> worker_;
  std::uint64_t sorted_at_ = 0;  ///< crossings when the needles were last sorted

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
EventLoop<Search, Queue, effects>::EventLoop(const Scene& scene, Gas initial,
                                             const SearchSetup& setup)
    : Run(scene, std::move(initial)),
      search_(gas, tally.counters, setup),
      queue_(make_queue(gas, search_)),
      worker_(*this, search_, queue_, tally) {
  if constexpr (effects.contact_time) {
    last_collision.assign(gas.size(), Time{-(std::int64_t{1} << 62), 0});
  }
  const Needle count = static_cast<Needle>(gas.size());
  std::vector<Time> placed_until(count);
  for (Needle i = 0; i < count; ++i) placed_until[i] = search_.place(i, now);
  for (Needle i = 0; i < count; ++i) worker_.schedule(i, placed_until[i]);
}

template <class Search, class Queue, Effects effects>
EventLoop<Search, Queue, effects>::Limits::Limits(const Run& run, const Scene::Until& until)
    : time(until.time ? run.gas.clock.add({}, std::max(0.0, *until.time)) : Time::never()),
      collisions(until.collisions_per_needle
                     ? *until.collisions_per_needle * static_cast<double>(run.gas.size()) / 2
                     : std::numeric_limits<double>::infinity()),
      energy(until.energy_ratio ? *until.energy_ratio * run.initial_energy : -1),
      wall(std::chrono::steady_clock::time_point::max()) {
  if (!until.time && !until.collisions_per_needle && !until.energy_ratio && !until.wall_s) {
    throw InputError("until: expected at least one end condition");
  }
  if (until.wall_s) {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> left(*until.wall_s);
    if (left < wall - now) {
      wall = now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(left);
    }
  }
}

template <class Search, class Queue, Effects effects>
std::optional<Stop> EventLoop<Search, Queue, effects>::reached(const Limits& limits) const {
  if (static_cast<double>(tally.collisions) >= limits.collisions) return Stop::collisions;
  if (energy() <= limits.energy) return Stop::energy;
  return std::nullopt;
}

template <class Search, class Queue, Effects effects>
std::optional<Stop> EventLoop<Search, Queue, effects>::called_off(const Limits& limits) const {
  if (interrupted) return Stop::interrupted;
  if (limits.wall != limits.wall.max() && std::chrono::steady_clock::now() >= limits.wall) {
    return Stop::wall_time;
  }
  return std::nullopt;
}

template <class Search, class Queue, Effects effects>
Stop EventLoop<Search, Queue, effects>::advance(const Scene::Until& until) {
  interrupted = false;
  const Limits limits(*this, until);
  if (const auto stop = needs_no_events(limits)) return *stop;
  return *run_alone(limits, Time::never());
}

template <class Search, class Queue, Effects effects>
std::optional<Stop> EventLoop<Search, Queue, effects>::needs_no_events(const Limits& limits) {
  if (limits.time < now) return Stop::time;
  if (!nothing_can_happen()) return std::nullopt;
  if (limits.time == Time::never()) return Stop::nothing_can_happen;
  now = limits.time;
  return Stop::time;
}

template <class Search, class Queue, Effects effects>
std::optional<Stop> EventLoop<Search, Queue, effects>::run_alone(const Limits& limits, Time end) {
  for (;;) {
    if (const auto stop = reached(limits)) return stop;
    if (tally.counters.events % 256 == 0) {
      if (const auto stop = called_off(limits)) return stop;
    }
    const Event event = queue_.top();
    worker_.bring_near(event.owner);
    if constexpr (requires { queue_.soon(); }) worker_.bring_near(queue_.soon());
    if (pass_window(event.time, limits)) continue;
    if (event.time > limits.time) {
      now = limits.time;
      return Stop::time;
    }
    if (event.time >= end) {
      if (event.time == Time::never()) return Stop::nothing_can_happen;
      return std::nullopt;
    }
    worker_.happen(event, worker_.is_stale(event));
    now = event.time;
  }
}

template <class Search, class Queue, Effects effects>
bool EventLoop<Search, Queue, effects>::pass_window(Time next, const Limits& limits) {
  const Time until = std::min(next, limits.time);
  if (window_end_ > until || until == Time::never()) return false;
  now = window_end_;
  open_window();
  // Measured: after 2 to 8 of each needle the order is about as good, but sorting costs.
  constexpr std::uint64_t crossings = 6;
  if (sorted && tally.counters.crossings - sorted_at_ > crossings * gas.size()) sort_storage();
  return true;
}

// Stores neighbours in space next to each other again, once many have moved on.
template <class Search, class Queue, Effects effects>
void EventLoop<Search, Queue, effects>::sort_storage() {
  ++tally.counters.sorts;
  sorted_at_ = tally.counters.crossings;
  const std::vector<Needle> order = order_in_space(gas, now), ranks = ranks_of(order);
  reorder(gas, order);
  search_.renumber(ranks);
  if constexpr (effects.contact_time) permute(last_collision, order);
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
