// How the next event of a run is found and made to happen, whatever the search, calendar, effects
// and number of threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>

#include "src/engine/run.h"

namespace needlework {

/// Ends of a call of Simulation::advance().
struct Limits {
  /// Throws InputError without any condition.
  Limits(const Run& run, const Scene::Until& until);

  /// Brings a run that is at its end, or in which nothing can happen, there.
  std::optional<Stop> reached_without_events(Run& run) const;
  /// The limit that has been met, of those of the state.
  std::optional<Stop> reached(const Run& run) const {
    if (static_cast<double>(run.tally.collisions) >= collisions) return Stop::collisions;
    if (run.energy() <= energy) return Stop::energy;
    return std::nullopt;
  }
  /// The limit that has been met, of those from outside.
  std::optional<Stop> called_off(const Run& run) const;

  Time time;  ///< never: none
  double collisions;
  double energy;
  std::chrono::steady_clock::time_point wall;
  /// Soon after so many collisions the loop comes back without having met a limit.
  std::uint64_t pause = std::numeric_limits<std::uint64_t>::max();
};

class Loop {
 public:
  virtual ~Loop() = default;

  /// Goes on until a limit is met; without a value when it pauses before. Throws InvalidStateError
  /// when the run cannot go on correctly; the state stays as it was before the event that failed.
  virtual std::optional<Stop> advance(const Limits& limits) = 0;
  virtual const char* search_name() const = 0;
  virtual const char* calendar_name() const = 0;
};

}  // namespace needlework
