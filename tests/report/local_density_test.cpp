#include "src/report/local_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace needlework::report {
namespace {

State centres(std::array<double, 3> box, std::vector<std::array<double, 3>> position) {
  State state;
  state.box = box;
  state.position = std::move(position);
  return state;
}

std::vector<std::size_t> all(const State& state) {
  std::vector<std::size_t> numbers(state.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

TEST(LocalDensity, CountsOthersWithinTheSphereAcrossFaces) {
  const State state = centres({4, 4, 4}, {{0.1, 2, 2}, {3.9, 2, 2}, {0.1, 2.5, 2}, {2, 2, 2}});
  const float one = static_cast<float>(3 / (4 * std::numbers::pi));
  const auto density = local_density(state, 1, all(state));
  EXPECT_FLOAT_EQ(density[0], 2 * one);
  EXPECT_FLOAT_EQ(density[1], 2 * one);
  EXPECT_FLOAT_EQ(density[2], 2 * one);
  EXPECT_FLOAT_EQ(density[3], 0);
}

TEST(LocalDensity, IsThatOfAllPairsInBoxesOfAnyShape) {
  for (const std::array<double, 3> box :
       {std::array{2.01, 2.5, 9.0}, {3.0, 3.0, 3.0}, {20.0, 7.3, 2.2}}) {
    State state = centres(box, {});
    for (int i = 0; i < 300; ++i) {
      std::array<double, 3> place{};
      for (int a = 0; a < 3; ++a) {
        // Low-discrepancy places, some of them outside of the box.
        const double share = std::fmod(0.5 + i * (a == 0 ? 0.8192 : a == 1 ? 0.6710 : 0.5497), 1.0);
        place[a] = box[a] * (i % 7 == 0 ? share - 1 : share);
      }
      state.position.push_back(place);
    }
    const auto density = local_density(state, 1, all(state));
    for (std::size_t i = 0; i < state.size(); ++i) {
      int count = 0;
      for (std::size_t j = 0; j < state.size(); ++j) {
        double squared = 0;
        for (int a = 0; a < 3; ++a) {
          const double d = state.position[i][a] - state.position[j][a];
          const double nearest = d - box[a] * std::round(d / box[a]);
          squared += nearest * nearest;
        }
        count += j != i && squared <= 1;
      }
      EXPECT_FLOAT_EQ(density[i], static_cast<float>(count * 3 / (4 * std::numbers::pi)))
          << "needle " << i << " in a box of " << box[0];
    }
  }
}

}  // namespace
}  // namespace needlework::report
