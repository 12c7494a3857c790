// One scene, followed by loops that differ.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "src/engine/drawn_state.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "src/engine/run.h"
#include "tests/support/runs.h"

namespace needlework::test {

/// A loop for a run by the names of its search and its calendar.
inline auto loop_of(const char* search, const char* calendar) {
  return [=](Run& run) { return make_loop(run, {.search = search, .calendar = calendar}); };
}

struct Trajectory {
  std::string hash;
  std::uint64_t collisions = 0;
  std::uint64_t events = 0;  ///< of the first source, if there is one
};

/// Follows the scene from its drawn state until a time by the loop that `make(run)` gives.
template <class Make>
Trajectory trajectory_of(const Scene& scene, const Make& make, double time) {
  Run run(scene, make_gas(scene, draw_initial_state(scene)));
  const auto loop = make(run);
  EXPECT_EQ(loop->advance(StopConditions(run, until_time(time))), Stop::time);
  Trajectory out{run.tally.hash.hex(), run.tally.collisions};
  if (!run.tally.by_source.empty()) out.events = run.tally.by_source[0].events;
  return out;
}

}  // namespace needlework::test
