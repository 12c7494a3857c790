// Bodies that grow in C.
#include <cmath>

#include "tests/c/c_simulation.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

using test::CSimulation;

TEST(CGrowth, IsGiven) {
  const CSimulation gas(
      "needles = { count = 60, box = 6, diameter = 0.3 }\n"
      "driving.growth = { rate = 0.1, until_packing = 0.2 }\n");
  needlework_growth growth{};
  EXPECT_EQ(needlework_get_growth(gas, &growth), NEEDLEWORK_OK) << gas.error.message;
  EXPECT_DOUBLE_EQ(growth.scale, 1);
  EXPECT_GT(growth.rate, 0);
  EXPECT_TRUE(std::isnan(growth.pressure));
  int stop = 0;
  const needlework_limits limits{.time = 1000};
  EXPECT_EQ(needlework_run_until(gas, &limits, &stop), NEEDLEWORK_OK) << gas.error.message;
  EXPECT_EQ(stop, NEEDLEWORK_STOP_GROWN);
  EXPECT_EQ(needlework_get_growth(gas, &growth), NEEDLEWORK_OK);
  EXPECT_NEAR(growth.packing_fraction, 0.2, 1e-12);
  EXPECT_GT(growth.scale, 1);
  EXPECT_GT(growth.pressure, 1);
  needlework_rods rods{};
  EXPECT_EQ(needlework_get_rods(gas, &rods), NEEDLEWORK_OK);
  EXPECT_EQ(rods.packing_fraction, growth.packing_fraction);
  double lengths[60], diameters[60];
  EXPECT_EQ(needlework_get_bodies(gas, lengths, diameters, nullptr, nullptr), NEEDLEWORK_OK);
  EXPECT_DOUBLE_EQ(lengths[7], growth.scale);
  EXPECT_DOUBLE_EQ(diameters[7], 0.3 * growth.scale);
  EXPECT_EQ(needlework_get_growth(gas, nullptr), NEEDLEWORK_USAGE);
}

// A scene that sets no other end: limits may be NULL.
TEST(CGrowth, IsAnEndOfItsOwn) {
  const CSimulation gas(
      "needles = { count = 60, box = 6, diameter = 0.3 }\n"
      "driving.growth = { rate = 0.1, until_packing = 0.15 }\n");
  int stop = 0;
  EXPECT_EQ(needlework_run_until(gas, nullptr, &stop), NEEDLEWORK_OK) << gas.message();
  EXPECT_EQ(stop, NEEDLEWORK_STOP_GROWN);
}

TEST(CGrowth, IsThatOfBodiesThatACallerGives) {
  const CSimulation drawn("needles = { count = 60, box = 6, diameter = 0.3 }\n");
  const test::Arrays arrays(drawn);
  const needlework_initial initial = arrays.initial(6);
  std::vector<double> diameter(60, 0.2), thin(60, 0);
  diameter[7] = 0.3;
  needlework_bodies bodies{};
  bodies.diameter = diameter.data();
  needlework_error error{};
  const char* const scene = "driving.growth.rate = 0.1\n";
  needlework_simulation* gas =
      needlework_create_with_bodies(scene, &initial, nullptr, nullptr, &bodies, 0, &error);
  ASSERT_TRUE(gas) << error.message;
  const needlework_limits limits{.time = 1};
  EXPECT_EQ(needlework_run_until(gas, &limits, nullptr), NEEDLEWORK_OK);
  needlework_growth growth{};
  EXPECT_EQ(needlework_get_growth(gas, &growth), NEEDLEWORK_OK);
  EXPECT_GT(growth.scale, 1);
  std::vector<double> now(60);
  EXPECT_EQ(needlework_get_bodies(gas, nullptr, now.data(), nullptr, nullptr), NEEDLEWORK_OK);
  EXPECT_DOUBLE_EQ(now[7], 0.3 * growth.scale);
  needlework_destroy(gas);
  bodies.diameter = thin.data();
  gas = needlework_create_with_bodies(scene, &initial, nullptr, nullptr, &bodies, 0, &error);
  EXPECT_FALSE(gas);
  EXPECT_TRUE(test::contains(error.message, "expected bodies with a diameter")) << error.message;
}

TEST(CGrowth, IsNoneWithoutAny) {
  const CSimulation gas("needles = { count = 60, box = 6, diameter = 0.3 }\n");
  needlework_growth growth{};
  EXPECT_EQ(needlework_get_growth(gas, &growth), NEEDLEWORK_OK);
  needlework_rods rods{};
  EXPECT_EQ(needlework_get_rods(gas, &rods), NEEDLEWORK_OK);
  EXPECT_EQ(growth.scale, 1);
  EXPECT_EQ(growth.rate, 0);
  EXPECT_EQ(growth.packing_fraction, rods.packing_fraction);
  EXPECT_TRUE(std::isnan(growth.pressure));
}

}  // namespace
}  // namespace needlework
