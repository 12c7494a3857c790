#include "src/search/sizing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "src/search/choice.h"
#include "tests/search/gas_drive.h"

namespace needlework::test {
namespace {

// In the part of the box up to `filled` of its edge.
Gas gas_in(double filled, std::size_t count, double edge) {
  Random random(5);
  Gas gas = gas_of(count, {edge, edge, edge});
  const auto place = [&] { return random.uniform(0, filled * edge); };
  for (Needle i{0}; i < count; ++i) {
    put(gas, i, {place(), place(), place()}, {1, 0, 0}, {0, 1, 0}, {});
  }
  return gas;
}

TEST(Sizing, OfAnEvenGasIsItsDensity) {
  for (const double density : {0.1, 0.72, 2.5, 11.6, 50.0}) {
    const Gas gas = gas_in(1, 4000, std::cbrt(4000 / density));
    EXPECT_EQ(Sizing(gas, {}).density(), gas.density());
  }
}

TEST(Sizing, OfACloudIsTheDensityInIt) {
  for (const double filled : {0.5, 0.1}) {
    const Gas gas = gas_in(filled, 4000, 60);
    const double within = gas.density() / (filled * filled * filled);
    EXPECT_NEAR(Sizing(gas, {}).density(), within, 0.2 * within) << filled;
  }
}

TEST(Sizing, IsCountedWhereNeedlesHaveCome) {
  Gas gas = gas_in(0.1, 4000, 60);
  Sizing sizing(gas, {});
  const double first = sizing.density();
  EXPECT_EQ(sizing.next(), 4000u);
  // Each flies on with its own velocity, so that the cloud is twice as long each way.
  Random random(6);
  for (Needle i{0}; i < gas.size(); ++i) {
    const auto speed = [&] { return random.uniform(0, 6); };
    put(gas, i, gas.records[i].flight.r, {1, 0, 0}, {speed(), speed(), speed()}, {});
  }
  EXPECT_FALSE(sizing.look(4100, gas, {}));
  EXPECT_EQ(sizing.density(), first);
  EXPECT_EQ(sizing.next(), 4100u + 8000);
  EXPECT_TRUE(sizing.look(9000, gas, gas.clock.add({}, 1)));
  EXPECT_EQ(sizing.next(), 9000u + 4000);
  EXPECT_LT(sizing.density(), 0.4 * first);
  EXPECT_GT(sizing.density(), 0.1 * first);
}

TEST(Sizing, IsCountedMoreRarelyWhereItDoesNotChange) {
  const Gas gas = gas_in(1, 4000, 20);
  Sizing sizing(gas, {});
  std::uint64_t last = 0;
  for (const std::uint64_t apart : {4000, 8000, 16000, 16000}) {
    EXPECT_EQ(sizing.next(), last + apart);
    last = sizing.next();
    EXPECT_FALSE(sizing.look(last, gas, {}));
  }
}

// Long needles that are few do not make a gas dense.
TEST(Choice, OfTheSearchIsByTheMeanLength) {
  const auto mixture = [](std::uint64_t long_ones) {
    return Composition({{.name = "short", .count = 100 - long_ones, .length = 0.25},
                        {.name = "long", .count = long_ones, .length = 2}},
                       {});
  };
  EXPECT_EQ(density_by_mean(7, {}), 7);
  EXPECT_EQ(density_by_mean(7, mixture(100)), 7);
  EXPECT_DOUBLE_EQ(density_by_mean(512, mixture(0)), 512);  // per cube of those that are there
  EXPECT_DOUBLE_EQ(mean_length(mixture(50)), 0.5625);
  for (const double density : {3.0, 100.0}) {
    EXPECT_EQ(chosen_search("auto", density, mixture(100)), "capsules");
    EXPECT_EQ(chosen_search("auto", density, mixture(10)), "linked-cells");
    EXPECT_EQ(chosen_search("capsules", density, mixture(10)), "capsules");
  }
}

// Rods meet more often than needles as long: at low density by the area of their excluded body, and
// by what keeps them at contact in a dense fluid.
TEST(Choice, KnowsThatRodsMeetMoreOftenThanNeedles) {
  const auto rods = [](double length) {
    return Composition({{.name = "rods", .count = 100, .length = length, .diameter = 1}}, {});
  };
  EXPECT_EQ(crowding_by_width(7, {}), 1);
  EXPECT_NEAR(crowding_by_width(1e-9, rods(0)), 8, 1e-6);
  EXPECT_NEAR(crowding_by_width(1e-9, rods(5)), 73.0 / 36, 1e-6);
  EXPECT_NEAR(crowding_by_width(1e-9, rods(1e5)), 1, 1e-3);
  // Spheres at a packing fraction of 0.3.
  EXPECT_NEAR(crowding_by_width(0.3 * 6 / std::numbers::pi, rods(0)), 8 * 0.85 / 0.343, 1e-6);
  EXPECT_EQ(chosen_search("auto", 0.6, rods(0)), "capsules");
  EXPECT_EQ(chosen_search("auto", 0.02, rods(0)), "linked-cells");
  EXPECT_EQ(chosen_search("auto", 0.6, {}), "linked-cells");
}

// In a box of any size.
TEST(Sizing, OfASmallCloudIsTheDensityInIt) {
  for (const double edge : {400.0, 1e4, 2e6}) {
    const double within = 4000 / 125.0;
    EXPECT_NEAR(Sizing(gas_in(5 / edge, 4000, edge), {}).density(), within, 0.4 * within) << edge;
  }
}

// A few pairs may be near each other by chance.
TEST(Sizing, OfFewNeedlesIsTheirDensity) {
  for (const std::size_t count : {2, 10, 64, 150}) {
    for (const double edge : {2.01, 10.0, 30.0, 120.0}) {
      const Gas gas = gas_in(1, count, edge);
      EXPECT_EQ(Sizing(gas, {}).density(), gas.density()) << count << ' ' << edge;
    }
  }
}

}  // namespace
}  // namespace needlework::test
