#include "src/observe/batch_rate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace needlework {
namespace {

TEST(BatchRate, HasNoErrorForEventsAtEqualIntervals) {
  BatchRate rate(1);
  for (int n = 0; n < 10 * 4; ++n) rate.add(0.25 * n);
  const auto estimate = rate.estimate(10);
  EXPECT_EQ(estimate.batches, 10);
  EXPECT_DOUBLE_EQ(estimate.rate, 4);
  EXPECT_EQ(estimate.standard_error, 0);
}

TEST(BatchRate, TakesItsErrorFromTheSpreadOfBatches) {
  BatchRate rate(2);
  const int counts[] = {3, 5, 3, 5, 3, 5, 3, 5};  // of mean 4 and variance 8/7
  for (int batch = 0; batch < 8; ++batch) {
    for (int n = 0; n < counts[batch]; ++n) rate.add(2 * batch + 0.1 * n);
  }
  const auto estimate = rate.estimate(16);
  EXPECT_DOUBLE_EQ(estimate.rate, 4.0 / 2);
  EXPECT_DOUBLE_EQ(estimate.standard_error, std::sqrt(8.0 / 7 / 8) / 2);
}

TEST(BatchRate, CountsEventsInAnyOrder) {
  std::mt19937 random(7);
  std::exponential_distribution<double> gap(3);
  std::vector<double> times;
  for (double time = 0; times.size() < 2000;) times.push_back(time += gap(random));
  const double end = times.back();
  BatchRate in_order(0.7), shuffled(0.7);
  for (const double time : times) in_order.add(time);
  std::shuffle(times.begin(), times.end(), random);
  for (const double time : times) shuffled.add(time);
  EXPECT_EQ(shuffled.estimate(end).rate, in_order.estimate(end).rate);
  EXPECT_EQ(shuffled.estimate(end).standard_error, in_order.estimate(end).standard_error);
}

TEST(BatchRate, LeavesOutTheUnfinishedBatch) {
  BatchRate rate(1);
  for (int n = 0; n < 8; ++n) rate.add(n + 0.5);
  rate.add(8.1);
  rate.add(8.2);
  EXPECT_DOUBLE_EQ(rate.estimate(8.9).rate, 1);
  EXPECT_DOUBLE_EQ(rate.estimate(9).rate, 10.0 / 9);
}

TEST(BatchRate, CountsBatchesWithoutEvents) {
  BatchRate rate(1);
  rate.add(0.5);
  const auto estimate = rate.estimate(10);
  EXPECT_DOUBLE_EQ(estimate.rate, 0.1);
  EXPECT_NEAR(estimate.standard_error, 0.1, 1e-12);  // sqrt((0.81 + 9 * 0.01) / 9 / 10)
}

TEST(BatchRate, HasNoErrorFromTooFewBatches) {
  BatchRate rate(1);
  for (int n = 0; n < 7; ++n) rate.add(n + 0.5);
  EXPECT_TRUE(std::isnan(rate.estimate(7).standard_error));
  EXPECT_DOUBLE_EQ(rate.estimate(7).rate, 1);
  EXPECT_TRUE(std::isnan(rate.estimate(0.5).rate));
}

TEST(BatchRate, JoinsBatchesWithoutLosingEvents) {
  BatchRate rate(1);
  for (int n = 0; n < 100000; ++n) rate.add(0.5 * n + 0.25);
  const auto estimate = rate.estimate(50000);
  EXPECT_GE(estimate.batches, BatchRate::most_batches / 2);
  EXPECT_LE(estimate.batches, BatchRate::most_batches);
  EXPECT_DOUBLE_EQ(estimate.rate, 2);
  EXPECT_EQ(estimate.standard_error, 0);
}

// Independent events at rate 5: the error is that of a Poisson count, sqrt(rate / time), itself
// known to 1 / sqrt(2 * 31) = 13 %; four of these are allowed. Events in pairs double the variance.
TEST(BatchRate, SeesCorrelationThatCountsDoNot) {
  for (const int together : {1, 2}) {
    std::mt19937_64 random(1);
    std::exponential_distribution<double> gap(5.0);
    BatchRate rate(2);
    double time = 0;
    for (;;) {
      time += gap(random) * together;
      if (time > 10000) break;
      for (int n = 0; n < together; ++n) rate.add(time);
    }
    const auto estimate = rate.estimate(10000);
    const double expected = std::sqrt(5.0 * together / 10000);
    EXPECT_NEAR(estimate.standard_error, expected, 4 * 0.13 * expected) << together;
    EXPECT_NEAR(estimate.rate, 5, 4 * expected) << together;
  }
}

}  // namespace
}  // namespace needlework
