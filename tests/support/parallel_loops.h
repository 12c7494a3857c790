// Loops of several threads with other settings than the engine's own.
#pragma once

#include <memory>
#include <utility>

#include "src/engine/loops/loops.h"
#include "src/engine/run.h"

namespace needlework::test {

/// "linked-cells" or "capsules" on so many threads; `run` must outlive the loop.
inline std::unique_ptr<Loop> parallel_loop(Run& run, const char* search, int threads,
                                           const ParallelTuning& tuning,
                                           const SearchSetup& setup = {}) {
  NearSearch near(run.gas, run.tally.counters, setup, NearSearch::kind_of(search).value());
  return make_parallel_loop(run, std::move(near), ReplacedRecords(), threads, tuning);
}

/// In which even few collisions make a phase worth sharing.
inline constexpr ParallelTuning short_phases = {.least = 1, .by_cost = false};

}  // namespace needlework::test
