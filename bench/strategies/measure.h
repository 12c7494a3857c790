// Measures one case once, in a process of its own.
#pragma once

#include <cstdint>
#include <string>

#include "bench/strategies/cases.h"
#include "needlework/counters.h"

namespace needlework::bench {

struct CounterName {
  const char* name;
  std::uint64_t Counters::*member;
};
inline constexpr CounterName counter_names[] = {{"events", &Counters::events},
                                                {"searches", &Counters::searches},
                                                {"candidates", &Counters::candidates},
                                                {"filtered", &Counters::filtered},
                                                {"isolated", &Counters::isolated},
                                                {"predicted", &Counters::predicted},
                                                {"evaluated", &Counters::evaluated},
                                                {"escalated", &Counters::escalated},
                                                {"rebuilds", &Counters::rebuilds},
                                                {"crossings", &Counters::crossings},
                                                {"stale", &Counters::stale}};

/// One repetition of a case.
struct Sample {
  double setup_s = 0;            ///< CPU time until the first event can happen [s]
  double cpu_s = 0;              ///< CPU time of the event loop [s]
  std::uint64_t collisions = 0;  ///< in that time
  Counters counters;             ///< of the same
  std::uint64_t bytes = 0;       ///< most memory that the simulation held, set-up included
  std::string search, queue, effects;
  std::string warm_up_hash;  ///< of the trajectory up to where the clock starts
};

/// Collisions per needle before the clock starts, and at least after. All needles are placed at the
/// start, so that for nearly the first of these they leave their hulls too seldom.
inline constexpr double warm_up = 1, stretch = 0.5;

/// Measures stretches until they have taken `min_time` seconds of CPU time; the collisions are the
/// same each time but for their number. The process is forked, so that memory is its own and caches
/// are as others have left them. Throws InvalidStateError when it fails.
Sample measure(const Case& what, double min_time);

}  // namespace needlework::bench
