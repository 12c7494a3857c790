// Sums over all needles on several threads, against plain ones on one.
#include "src/engine/exact_sums.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "src/physics/vectors.h"
#include "tests/support/random.h"

namespace needlework::test {
namespace {

LargeArray<Record> records_of(Random& random, std::size_t count, double scale) {
  LargeArray<Record> out(count);
  for (Record& record : out) {
    const auto number = [&] { return scale * random.uniform(-1, 1); };
    record.flight.v = {number(), number(), number()};
    record.flight.w = {number(), number(), number()};
  }
  return out;
}

std::array<double, 3> sums_on(int threads, const LargeArray<Record>& records) {
  return exact_sums(records, threads, [](const Record& a) {
    return std::array{dot(a.flight.v, a.flight.v), dot(a.flight.w, a.flight.w), a.flight.v.x};
  });
}

template <class Term>
double plain_sum(const LargeArray<Record>& records, const Term& term) {
  double largest = 0;
  for (const Record& record : records) largest = std::max(largest, std::abs(term(record)));
  ExactSum sum(largest);
  for (const Record& record : records) sum.add(term(record));
  return sum.value();
}

TEST(ExactSums, AreThePlainOnesOnAnyNumberOfThreads) {
  Random random(2424);
  for (const std::size_t count : {0, 1, 7, 1024, 5000, 20000}) {
    for (const double scale : {1.0, 1e-150, 1e150, 0.0}) {
      const LargeArray<Record> records = records_of(random, count, scale);
      const std::array<double, 3> plain = {
          plain_sum(records, [](const Record& a) { return dot(a.flight.v, a.flight.v); }),
          plain_sum(records, [](const Record& a) { return dot(a.flight.w, a.flight.w); }),
          plain_sum(records, [](const Record& a) { return a.flight.v.x; })};
      for (const int threads : {1, 2, 3, 8}) {
        EXPECT_EQ(sums_on(threads, records), plain)
            << count << " needles, speed " << scale << ", " << threads << " threads";
      }
    }
  }
}

TEST(ExactSums, AreInfiniteWhereATermIs) {
  Random random(2424);
  LargeArray<Record> records = records_of(random, 5000, 1);
  const std::array<double, 3> finite = sums_on(1, records);
  records[4000].flight.v.y = 1e200;
  for (const int threads : {1, 2}) {
    const std::array<double, 3> sums = sums_on(threads, records);
    EXPECT_EQ(sums[0], std::numeric_limits<double>::infinity());
    EXPECT_EQ(sums[1], finite[1]);
    EXPECT_EQ(sums[2], finite[2]);
  }
}

}  // namespace
}  // namespace needlework::test
