// Sums over all needles on several threads, against sums in two passes on one.
#include "src/engine/motion_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "src/physics/vectors.h"
#include "src/trajectory/exact_sum.h"
#include "tests/support/random.h"

namespace needlework::test {
namespace {

constexpr std::uint64_t seed = 2424;

LargeArray<Record> records_of(Random& random, std::size_t count, double scale) {
  LargeArray<Record> out(count);
  for (Record& record : out) {
    const auto number = [&] { return scale * random.uniform(-1, 1); };
    record.flight.v = {number(), number(), number()};
    record.flight.w = {number(), number(), number()};
  }
  return out;
}

template <class Term>
double plain_sum(const LargeArray<Record>& records, const Term& term) {
  double largest = 0;
  for (const Record& record : records) largest = std::max(largest, std::abs(term(record)));
  if (!std::isfinite(largest)) return largest;
  ExactSum sum(largest);
  for (const Record& record : records) sum.add(term(record));
  return sum.value();
}

void expect_sums_of(const LargeArray<Record>& records, const MotionSums& sums) {
  EXPECT_EQ(sums.v2,
            plain_sum(records, [](const Record& a) { return dot(a.flight.v, a.flight.v); }));
  EXPECT_EQ(sums.w2,
            plain_sum(records, [](const Record& a) { return dot(a.flight.w, a.flight.w); }));
  EXPECT_EQ(sums.v[0], plain_sum(records, [](const Record& a) { return a.flight.v.x; }));
  EXPECT_EQ(sums.v[1], plain_sum(records, [](const Record& a) { return a.flight.v.y; }));
  EXPECT_EQ(sums.v[2], plain_sum(records, [](const Record& a) { return a.flight.v.z; }));
}

// One object sums gases of the most different speeds, so that the grids of the last sums are right,
// too fine, too coarse, or far from any term.
TEST(MotionSums, AreThoseOfTwoPassesOnAnyNumberOfThreads) {
  Random random(seed);
  const MotionSummation summation;
  for (const std::size_t count : {0, 1, 7, 1024, 5000, 20000}) {
    for (const double scale : {1.0, 1.01, 1e-3, 1e3, 1e-150, 1e150, 0.0, 1.0}) {
      const LargeArray<Record> records = records_of(random, count, scale);
      for (const int threads : {1, 2, 3, 8}) {
        SCOPED_TRACE(std::to_string(count) + " needles, speed " + std::to_string(scale) + ", " +
                     std::to_string(threads) + " threads");
        expect_sums_of(records, summation.of(records, threads));
      }
    }
  }
}

// The largest term is the last, on the last thread.
TEST(MotionSums, AreRightWhereTheGridIsKnownLate) {
  Random random(seed);
  LargeArray<Record> records = records_of(random, 20000, 1);
  for (const double last : {1e1, 1e3, 1e6, 1e100}) {
    records.back().flight.v.y = last;
    const MotionSummation summation;
    for (const int threads : {1, 4}) expect_sums_of(records, summation.of(records, threads));
  }
}

TEST(MotionSums, AreInfiniteWhereATermIs) {
  Random random(seed);
  LargeArray<Record> records = records_of(random, 5000, 1);
  records[4000].flight.v.x = 1e200;
  const MotionSummation summation;
  for (const int threads : {1, 2}) {
    const MotionSums sums = summation.of(records, threads);
    EXPECT_EQ(sums.v2, std::numeric_limits<double>::infinity());
    expect_sums_of(records, sums);
  }
  records[4000].flight.v.x = 1;
  expect_sums_of(records, summation.of(records, 2));
}

}  // namespace
}  // namespace needlework::test
