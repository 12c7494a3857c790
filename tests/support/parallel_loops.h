// Loops of several threads with other settings than the engine's own.
#pragma once

#include <memory>
#include <utility>

#include "src/engine/parallel_loop.h"
#include "src/physics/needle_model.h"
#include "src/search/near_search.h"

namespace needlework::test {

/// "linked-cells" or "capsules" on so many threads, with the effects of the run if it is to have
/// any; `run` must outlive the loop.
template <bool with_effects>
std::unique_ptr<Loop> make_parallel_loop(Run& run, const char* search, int threads,
                                         const ParallelTuning& tuning,
                                         const SearchSetup& setup = {}) {
  NearSearch near(run.gas, run.tally.counters, setup, NearSearch::kind_of(search).value());
  return std::make_unique<ParallelLoop<NearSearch, NeedleModel<with_effects>>>(
      run, std::move(near), ReplacedRecords(), threads, tuning);
}

/// In which even few collisions make a phase worth sharing.
inline constexpr ParallelTuning short_phases = {.least = 1, .by_cost = false};

}  // namespace needlework::test
