// Rates between walls, against values that were found independently.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "needlework/theory.h"

namespace needlework::theory {
namespace {

Species needles(double k) {
  Species out;
  out.k = k;
  return out;
}

constexpr std::array<bool, 3> along_z = {false, false, true};

TEST(WallRates, AreThoseOfAnIdealGas) {
  const auto rates = wall_rates(needles(6), {7, 8, 2}, along_z, {1, 1});
  EXPECT_NEAR(rates[2].hits, 0.4546, 5e-5);
  EXPECT_NEAR(rates[2].force, 2.0 / 3, 1e-12);  // T / (H - L/2)
  EXPECT_EQ(rates[0].hits, 0);
  // The same from the integral over u, by its own quadrature.
  double sum = 0;
  constexpr int steps = 20000;
  for (int n = 0; n < steps; ++n) {
    const double u = (n + 0.5) / steps;
    sum += std::sqrt(1 + 3 * (1 - u * u)) / steps;
  }
  EXPECT_NEAR(rates[2].hits, sum / (1.5 * std::sqrt(2 * std::numbers::pi)), 1e-8);
}

TEST(WallRates, ScaleWithLengthMassAndTemperature) {
  Species other = needles(3);
  other.length = 2;
  other.mass = 5;
  const auto large = wall_rates(other, {14, 16, 6}, along_z, {2, 1});
  other.length = 1;
  other.mass = 1;
  const auto small = wall_rates(other, {7, 8, 3}, along_z, {2, 1});
  EXPECT_NEAR(large[2].hits, small[2].hits / (2 * std::sqrt(5)), 1e-12);
  EXPECT_NEAR(large[2].force, small[2].force / 2, 1e-12);
  const auto hot = wall_rates(other, {7, 8, 3}, along_z, {8, 4});
  EXPECT_NEAR(hot[2].hits, 2 * small[2].hits, 1e-12);
  EXPECT_NEAR(hot[2].force, 4 * small[2].force, 1e-12);
}

// Virtual work: the forces are the derivatives of T ln(room) by the edges, where equipartition
// holds.
TEST(WallRates, AreThoseOfAllWallsAtOnce) {
  const auto log_room = [](const std::array<double, 3>& box) {
    double sum = 0;
    constexpr int steps = 400;
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) {
        const double z = (i + 0.5) / steps, angle = (j + 0.5) / steps * std::numbers::pi / 2;
        const double across = std::sqrt(1 - z * z);
        sum += (box[0] - across * std::cos(angle)) * (box[1] - across * std::sin(angle)) *
               (box[2] - z) / (steps * steps);
      }
    }
    return std::log(sum);
  };
  const std::array<double, 3> box = {1.5, 2, 3};
  const auto rates = wall_rates(needles(6), box, {true, true, true}, {1, 1});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<double, 3> wider = box, narrower = box;
    wider[axis] += 1e-3;
    narrower[axis] -= 1e-3;
    const double force = (log_room(wider) - log_room(narrower)) / 2e-3;
    EXPECT_NEAR(rates[axis].force, force, 1e-5) << axis;
  }
}

TEST(PairDepletion, HasItsKnownValues) {
  EXPECT_NEAR(pair_depletion(1, 2), 0.750791, 1e-6);
  EXPECT_NEAR(pair_depletion(1, 6), 0.753889, 1e-6);
  EXPECT_NEAR(pair_depletion(3, 2), pair_depletion(1, 6), 1e-12);
}

TEST(KickPower, CountsTheMomentumThatIsTakenOff) {
  Composition alone({needles(6)}, {});
  alone.set_count(0, 10);
  EXPECT_NEAR(kick_power(alone, 2, 3), 1.5 * 4 * 0.9 + 9.0 / 12, 1e-12);
  alone.set_count(0, 1);
  EXPECT_NEAR(kick_power(alone, 2, 0), 0, 1e-12);
  Species heavy = needles(2);
  heavy.mass = 4;
  Composition both({needles(6), heavy}, {});
  both.set_count(0, 6);
  both.set_count(1, 2);  // M = 14, sum of squares 38
  EXPECT_NEAR(kick_power(both, 1, 0), 1.5 * (14 - 38.0 / 14) / 8, 1e-12);
  EXPECT_NEAR(kick_power(both, 0, 1), (6 * (1.0 / 12) + 2 * 1.0) / 8, 1e-12);
}

}  // namespace
}  // namespace needlework::theory
