#include "src/observe/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace needlework {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<double> times_of(Schedule schedule, double end) {
  std::vector<double> times;
  while (schedule.next() <= end) {
    times.push_back(schedule.next());
    schedule.pass(schedule.next());
  }
  return times;
}

TEST(Schedule, HasExactPowersOfTenOnItsGrid) {
  EXPECT_EQ(times_of(Schedule::logarithmic(1, 0.01), 1e4),
            (std::vector<double>{0.01, 0.1, 1, 10, 100, 1000, 10000}));
  const auto times = times_of(Schedule::logarithmic(10, 0.5), 1000);
  for (const double power : {1.0, 10.0, 100.0, 1000.0}) {
    EXPECT_EQ(std::count(times.begin(), times.end(), power), 1) << power;
  }
}

TEST(Schedule, HasTheMultiplesOfAStep) {
  EXPECT_EQ(times_of(Schedule::linear(0.1), 0.45), (std::vector{0.1, 2 * 0.1, 3 * 0.1, 4 * 0.1}));
  Schedule schedule = Schedule::linear(2);
  schedule.pass(0);
  EXPECT_EQ(schedule.next(), 2);
  schedule.pass(7);
  EXPECT_EQ(schedule.next(), 8);
}

TEST(Schedule, TakesEqualStepsOfTheLogarithm) {
  const auto times = times_of(Schedule::logarithmic(8, 1e-3), 1e9);
  EXPECT_EQ(times.size(), 12u * 8 + 1);
  for (std::size_t i = 1; i < times.size(); ++i) {
    EXPECT_NEAR(times[i] / times[i - 1], std::pow(10, 1.0 / 8), 1e-13);
  }
}

TEST(Schedule, StartsAtTheFirstPointOfTheGridThatIsNotBefore) {
  EXPECT_EQ(Schedule::logarithmic(1, 0.011).next(), 0.1);
  EXPECT_EQ(Schedule::logarithmic(1, 0.1).next(), 0.1);
  EXPECT_EQ(Schedule::logarithmic(1, std::nextafter(0.1, 1)).next(), 1);
  EXPECT_EQ(Schedule::logarithmic(1, 2e200).next(), 1e201);
}

TEST(Schedule, DoesNotDependOnTheStartBeyondIt) {
  EXPECT_EQ(times_of(Schedule::logarithmic(7, 1), 1e5),
            times_of(Schedule::logarithmic(7, 0.999), 1e5));
}

TEST(Schedule, IsEmptyWithoutAUsableStart) {
  EXPECT_EQ(Schedule().next(), infinity);
  EXPECT_EQ(Schedule::logarithmic(10, 0).next(), infinity);
  EXPECT_EQ(Schedule::logarithmic(10, infinity).next(), infinity);
  EXPECT_EQ(Schedule::logarithmic(10, std::nan("")).next(), infinity);
}

TEST(Schedule, TakesAnyDensityOfPoints) {
  EXPECT_EQ(times_of(Schedule::logarithmic(1e6, 1), 1.001).size(), 435u);  // 1e6 log10(1.001) + 1
  EXPECT_EQ(Schedule::logarithmic(1e-300, 0.5).next(), 1);
  EXPECT_EQ(times_of(Schedule::logarithmic(1e-300, 0.5), 1e300).size(), 1u);
}

TEST(Schedule, PassesSeveralTimesAtOnce) {
  Schedule schedule = Schedule::logarithmic(1, 0.01);
  schedule.pass(5);
  EXPECT_EQ(schedule.next(), 10);
  schedule.pass(9.99);
  EXPECT_EQ(schedule.next(), 10);
}

TEST(Schedule, FollowsAListToItsEnd) {
  EXPECT_EQ(times_of(Schedule::at({0, 1.5, 7}), 100), (std::vector<double>{0, 1.5, 7}));
  Schedule schedule = Schedule::at({0, 1.5, 7});
  schedule.pass(1.5);
  EXPECT_EQ(schedule.next(), 7);
  schedule.pass(8);
  EXPECT_EQ(schedule.next(), infinity);
}

}  // namespace
}  // namespace needlework
