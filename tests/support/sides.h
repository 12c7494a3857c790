// On which sides of each other needles stand, by quad precision.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/contact_state.h"
#include "tests/support/quad_gas.h"

namespace needlework::test {

inline PairState pair_of(const State& state, std::size_t i, std::size_t j) {
  const auto needle = [&](std::size_t n) {
    return read(
        {state.position[n], state.orientation[n], state.velocity[n], state.angular_velocity[n]});
  };
  return {needle(i), needle(j)};
}

/// Whether no pair has come through each other between two states that are close in time: where the
/// lines meet on both needles in both, and cross at an angle, the side is the same. Returns for
/// how many pairs that could be decided. Needles must stay in the box.
inline int expect_same_sides(const State& before, const State& after) {
  int pairs = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t j = i + 1; j < before.size(); ++j) {
      const PairState was = pair_of(before, i, j), is = pair_of(after, i, j);
      const auto clear = [](const PairState& p) {
        const auto s = arms(p);
        return norm(cross(p.first.orientation, p.second.orientation)) > 0.1 && abs(s[0]) < 0.49 &&
               abs(s[1]) < 0.49 && abs(slopes(p).f) > 1e-12;
      };
      if (!clear(was) || !clear(is)) continue;
      ++pairs;
      EXPECT_EQ(slopes(was).f > 0, slopes(is).f > 0) << "needles " << i << " and " << j;
    }
  }
  return pairs;
}

}  // namespace needlework::test
