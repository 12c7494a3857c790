// The interface of all event loops, for any search, calendar, effects and number of threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>

#include "src/engine/run.h"

namespace needlework {

/// The limits at which a call of Simulation::advance() stops.
struct StopConditions {
  /// Throws InputError if no condition is given.
  StopConditions(const Run& run, const Scene::Until& until);

  /// Handles a run that is already at its end, or in which nothing can happen, without processing
  /// events. The time of the latter becomes the limit of time, if there is one.
  std::optional<Stop> reached_without_events(Run& run) const;
  /// The limit on collisions or energy that has been met, if any.
  std::optional<Stop> reached(const Run& run) const {
    if (static_cast<double>(run.tally.collisions) >= collisions) return Stop::collisions;
    if (run.present_energy() <= energy) return Stop::energy;
    if (run.growing && run.growing->is_over()) return run.growing->parameters().at_most;
    return std::nullopt;
  }
  /// Whether the caller has interrupted the run, the limit on wall time has passed, or no limit on
  /// time will end a gas without collisions.
  std::optional<Stop> called_off(Run& run) const;

  Time time;              ///< Time::never(): no limit
  Stop why = Stop::time;  ///< a run has ended that has come there
  double collisions;
  double energy;
  std::chrono::steady_clock::time_point wall;
  /// The loop returns soon after this number of collisions, without having met a limit.
  std::uint64_t pause = std::numeric_limits<std::uint64_t>::max();
};

class Loop {
 public:
  virtual ~Loop() = default;

  /// Lets all needles search their first events, and returns nothing when they have. Where the
  /// limits call the run off, returns why; the next call, or advance(), then continues. Without
  /// limits nothing stops it.
  virtual std::optional<Stop> prepare(const StopConditions* limits) = 0;
  /// Sorts the storage if so many needles have moved that it should be.
  virtual void keep_in_order() = 0;
  /// Begins again with records that have all been replaced at the present time, of which `replaced`
  /// holds the previous state. To be followed by prepare().
  virtual void begin_again(ReplacedRecords&& replaced) = 0;
  /// Processes events until a limit is met, or until the pause, when it returns nothing. Throws
  /// InvalidStateError when the run cannot continue correctly; the state then stays as it was
  /// before the event that failed, unless the error is an UnfinishedEventError.
  virtual std::optional<Stop> advance(const StopConditions& limits) = 0;
  virtual const char* search_name() const = 0;
  virtual const char* calendar_name() const = 0;
};

}  // namespace needlework
