#include "src/observe/completion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace needlework {
namespace {

constexpr double count = 100;

Totals totals(double time, std::uint64_t collisions, double energy) {
  Totals result;
  result.time = time;
  result.collisions = collisions;
  result.energy = energy;
  return result;
}

double fraction(const Scene::Until& until, const Totals& now, double elapsed = 0) {
  return completed_fraction(until, totals(0, 0, 2.5), now, count, elapsed);
}

TEST(CompletedFraction, IsTheShareOfCollisionsToCome) {
  Scene::Until until;
  until.collisions_per_needle = 10;  // 500 collisions
  EXPECT_DOUBLE_EQ(fraction(until, totals(3, 125, 1)), 0.25);
  EXPECT_DOUBLE_EQ(fraction(until, totals(3, 600, 1)), 1);
}

TEST(CompletedFraction, IsTheShareOfTimeInAnElasticGas) {
  Scene::Until until;
  until.time = 40;
  EXPECT_DOUBLE_EQ(fraction(until, totals(10, 125, 2.5)), 0.25);
}

TEST(CompletedFraction, FollowsHaffsLawInACoolingGas) {
  const double t0 = 3;
  const auto energy = [&](double time) { return 2.5 / std::pow(1 + time / t0, 2); };
  const double expected = std::log1p(50 / t0) / std::log1p(1e6 / t0);  // shares of collisions
  Scene::Until by_time;
  by_time.time = 1e6;
  EXPECT_NEAR(fraction(by_time, totals(50, 1, energy(50))), expected, 1e-12);
  Scene::Until by_energy;
  by_energy.energy_ratio = energy(1e6) / 2.5;
  EXPECT_NEAR(fraction(by_energy, totals(50, 1, energy(50))), expected, 1e-12);
}

TEST(CompletedFraction, IsThatOfTheFirstConditionToBeMet) {
  Scene::Until until;
  until.time = 1000;
  until.collisions_per_needle = 10;
  until.energy_ratio = 0.1;
  until.wall_s = 60;
  EXPECT_DOUBLE_EQ(fraction(until, totals(10, 125, 2.5), 1), 0.25);
  EXPECT_DOUBLE_EQ(fraction(until, totals(10, 125, 2.5), 30), 0.5);
}

TEST(CompletedFraction, IsAlwaysBetweenZeroAndOne) {
  Scene::Until until;
  until.time = 0;
  EXPECT_EQ(fraction(until, totals(0, 0, 2.5)), 1);
  until = {};
  until.energy_ratio = 2;
  EXPECT_EQ(fraction(until, totals(0, 0, 2.5)), 0);
  until = {};
  until.time = 10;
  EXPECT_EQ(completed_fraction(until, totals(0, 0, 0), totals(5, 0, 0), count, 0), 0.5);
}

}  // namespace
}  // namespace needlework
