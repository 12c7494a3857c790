// Measures one case once, in a process of its own.
#pragma once

#include <cstdint>
#include <string>

#include "bench/strategies/cases.h"
#include "needlework/counters.h"

namespace needlework::bench {

/// The counters of the work that one thread does, which results show for each collision.
inline constexpr Counters::Named counters_shown[] = {{"events", &Counters::events},
                                                     {"searches", &Counters::searches},
                                                     {"candidates", &Counters::candidates},
                                                     {"filtered", &Counters::filtered},
                                                     {"isolated", &Counters::bracket_steps},
                                                     {"predicted", &Counters::predicted},
                                                     {"evaluated", &Counters::evaluated},
                                                     {"escalated", &Counters::escalated},
                                                     {"rebuilds", &Counters::rebuilds},
                                                     {"crossings", &Counters::crossings},
                                                     {"stale", &Counters::stale}};

/// One repetition of a case.
struct Sample {
  double setup_s = 0;            ///< CPU time until the first event can be processed [s]
  double cpu_s = 0;              ///< CPU time of the event loop, all threads together [s]
  double wall_s = 0;             ///< its wall time [s]
  std::uint64_t collisions = 0;  ///< in cpu_s
  Counters counters;             ///< in cpu_s
  std::uint64_t bytes = 0;       ///< largest memory of the simulation, set-up included
  std::string search, calendar, effects;
  std::string warm_up_hash;  ///< trajectory hash when the measurement starts
};

/// Collisions per needle before the measurement starts, and the least number in it. All needles
/// are placed at the start, so during most of the first ones they leave their bounding volumes too
/// rarely.
inline constexpr double warm_up = 1, stretch = 0.5;

/// Measures stretches until they have used `min_time` seconds of CPU time. Repetitions have the
/// same collisions, except for their number. The process is forked, so that its memory is
/// separate; caches are as other processes have left them. Throws InvalidStateError if the
/// measurement fails.
Sample measure(const Case& what, double min_time);

}  // namespace needlework::bench
