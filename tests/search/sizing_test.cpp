#include "src/search/sizing.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/search/gas_drive.h"

namespace needlework::test {
namespace {

// In the part of the box up to `filled` of its edge.
Gas gas_in(double filled, Needle count, double edge) {
  Random random(5);
  Gas gas = gas_of(count, {edge, edge, edge});
  const auto place = [&] { return random.uniform(0, filled * edge); };
  for (Needle i = 0; i < count; ++i) {
    put(gas, i, {place(), place(), place()}, {1, 0, 0}, {0, 1, 0}, {});
  }
  return gas;
}

TEST(Sizing, OfAnEvenGasIsItsDensity) {
  for (const double density : {0.1, 0.72, 2.5, 11.6, 50.0}) {
    const Gas gas = gas_in(1, 4000, std::cbrt(4000 / density));
    EXPECT_EQ(Sizing(gas).density(), gas.density());
  }
}

TEST(Sizing, OfACloudIsTheDensityInIt) {
  for (const double filled : {0.5, 0.1}) {
    const Gas gas = gas_in(filled, 4000, 60);
    const double within = gas.density() / (filled * filled * filled);
    EXPECT_NEAR(Sizing(gas).density(), within, 0.2 * within) << filled;
  }
}

// Of searches that each find themselves and `others` in the cells that they look into.
void search(Counters& counters, std::uint64_t searches, std::uint64_t cells, std::uint64_t others) {
  counters.searches += searches;
  counters.cells += searches * cells;
  counters.candidates += searches * (1 + others);
}

TEST(Sizing, FollowsWhatSearchesFind) {
  const Gas gas = gas_in(1, 4000, 20);  // density 0.5
  Sizing sizing(gas);
  const double volume = 10;
  Counters counters;
  EXPECT_EQ(sizing.next(), 0u);
  search(counters, 4000, 20, 100);  // as expected
  EXPECT_FALSE(sizing.look(0, counters, volume));
  EXPECT_EQ(sizing.next(), 4000u);
  search(counters, 10000, 20, 190);  // 1.9 times as many; it is not the sum since the start
  EXPECT_FALSE(sizing.look(4000, counters, volume));
  EXPECT_EQ(sizing.density(), 0.5);
  search(counters, 10000, 20, 210);
  EXPECT_TRUE(sizing.look(8000, counters, volume));
  EXPECT_DOUBLE_EQ(sizing.density(), 1.05);
  EXPECT_EQ(sizing.next(), 12000u);
  search(counters, 10000, 30, 30);  // by the new search, with smaller cells
  EXPECT_FALSE(sizing.look(12000, counters, 1.5));
  search(counters, 10000, 30, 22);
  EXPECT_TRUE(sizing.look(16000, counters, 1.5));
  EXPECT_NEAR(sizing.density(), 22 / 45.0, 1e-12);
}

TEST(Sizing, KeepsItsDensityWhereNothingIsTold) {
  const Gas gas = gas_in(1, 4000, 20);
  Sizing sizing(gas);
  Counters counters;
  EXPECT_FALSE(sizing.look(100, counters, 10));  // no search
  counters.searches = counters.candidates = 10;  // one without cells
  EXPECT_FALSE(sizing.look(5000, counters, 0));
  search(counters, 100, 20, 0);  // all alone
  EXPECT_FALSE(sizing.look(9000, counters, 10));
  EXPECT_EQ(sizing.density(), 0.5);
}

TEST(Sizing, LeavesFewNeedlesAlone) {
  const Gas gas = gas_in(0.01, 63, 20);
  const Sizing sizing(gas);
  EXPECT_EQ(sizing.density(), gas.density());
  EXPECT_EQ(sizing.next(), std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
}  // namespace needlework::test
