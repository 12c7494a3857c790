// Rates between walls, against values that were found independently.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

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

// With T = m = 1 and n = 1 / (H - L/2), of needles with k = 6 sampled by another program.
TEST(WallRates, OfAWallThatMovesAreThoseOfASampledGas) {
  const double room = 1.5;
  for (const auto& [advance, force] : {std::array{1.0, 2.40987}, {-0.5, 0.60438}, {3.0, 8.81634}}) {
    const auto rates = wall_rates(needles(6), {7, 8, 2}, along_z, {1, 1}, advance);
    EXPECT_NEAR(room * rates[2].force, force, 2e-5) << advance;
    if (advance == 1) {
      EXPECT_NEAR(room * rates[2].hits, 1.29851, 1e-5);
    }
  }
  Species spheres = needles(6);
  spheres.length = 0;
  for (const auto& [advance, force] : {std::array{1.0, 3.84932}, {-0.5, 0.41928}, {3.0, 19.9996}}) {
    const auto rates = wall_rates(spheres, {7, 8, 2}, along_z, {1, 1}, advance);
    EXPECT_NEAR(2 * rates[2].force, force, 1e-4) << advance;
  }
  EXPECT_NEAR(2 * wall_rates(spheres, {7, 8, 2}, along_z, {1, 0})[2].force, 1, 1e-12);
  // Bodies at rest are swept up, or left.
  const auto swept = wall_rates(spheres, {7, 8, 2}, along_z, {0, 0}, 3);
  EXPECT_NEAR(swept[2].hits, 3 / 2.0, 1e-14);
  EXPECT_NEAR(swept[2].force, 2 * 9 / 2.0, 1e-13);
  EXPECT_EQ(wall_rates(spheres, {7, 8, 2}, along_z, {0, 0}, -3)[2].hits, 0);
  // A wall that hardly moves is one at rest.
  const auto resting = wall_rates(needles(6), {7, 8, 2}, along_z, {2, 1});
  const auto slow = wall_rates(needles(6), {7, 8, 2}, along_z, {2, 1}, 1e-9);
  EXPECT_NEAR(slow[2].hits, resting[2].hits, 2e-9);
  EXPECT_NEAR(slow[2].force, resting[2].force, 4e-9);
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

double factor(double k, Temperatures at, double gap) {
  return pair_factor_between_walls(needles(k), at, needles(k), at, gap);
}

// Between walls H >= 2 L apart it is H (H - delta L) / (H - L/2)^2 with one length delta.
TEST(PairFactor, HasItsKnownValuesBetweenDistantWalls) {
  for (const auto& [k, delta] : {std::pair(2.0, 0.750791), std::pair(6.0, 0.753889)}) {
    for (const double gap : {2.0, 2.5, 30.0}) {
      const double room = gap - 0.5;
      EXPECT_NEAR(factor(k, {1, 1}, gap), gap * (gap - delta) / (room * room), 2e-6) << gap;
    }
  }
  EXPECT_NEAR(factor(2, {1, 3}, 2.5), factor(6, {1, 1}, 2.5), 1e-12);
  EXPECT_EQ(factor(2, {0, 0}, 2.5), 1);
  EXPECT_NEAR(factor(2, {1, 1}, 1e6), 1, 1e-5);
}

// By drawn directors, contacts and heights, among those at which all tips are inside.
TEST(PairFactor, IsThatOfDrawnContacts) {
  Species small = needles(4), large = needles(1.5);
  small.length = 0.6;
  small.mass = 0.5;
  large.length = 1.3;
  large.mass = 3;
  const Temperatures cold{0.5, 1}, warm{2, 0.7};
  for (const double gap : {1.3, 1.5, 1.85, 1.95, 2.6}) {
    for (const auto& [a, b] : {std::pair(small, large), std::pair(large, large)}) {
      const Temperatures at_a = a.length < 1 ? cold : warm;
      std::mt19937_64 engine(7);
      std::uniform_real_distribution<double> uniform(0, 1);
      double all = 0, inside = 0, squares = 0;
      constexpr int samples = 600000;
      for (int n = 0; n < samples; ++n) {
        const double first = 2 * uniform(engine) - 1, second = 2 * uniform(engine) - 1;
        const double angle = 2 * std::numbers::pi * uniform(engine);
        const double cosine =
            first * second +
            std::sqrt((1 - first * first) * (1 - second * second)) * std::cos(angle);
        const double s = a.length * (uniform(engine) - 0.5), t = b.length * (uniform(engine) - 0.5);
        const double variance = at_a.t_tr / a.mass + warm.t_tr / b.mass +
                                at_a.t_rot * s * s / a.inertia() + warm.t_rot * t * t / b.inertia();
        const double weight = std::sqrt(std::max(0.0, 1 - cosine * cosine) * variance);
        const double height = gap * uniform(engine);
        const auto is_inside = [&](double centre, double reach) {
          return std::abs(centre - 0.5 * gap) + 0.5 * std::abs(reach) <= 0.5 * gap;
        };
        all += weight;
        if (!is_inside(height - s * first, a.length * first)) continue;
        if (!is_inside(height - t * second, b.length * second)) continue;
        inside += weight;
        squares += weight * weight;
      }
      const double room = (gap - 0.5 * a.length) * (gap - 0.5 * b.length) / (gap * gap);
      const double error = std::sqrt(squares) / all / room;
      EXPECT_LT(error, 0.003 * inside / all / room);
      EXPECT_NEAR(pair_factor_between_walls(a, at_a, b, warm, gap), inside / all / room, 3 * error)
          << gap << ", " << a.length;
    }
  }
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
