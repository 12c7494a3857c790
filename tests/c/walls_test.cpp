// Hits on walls in C: what a callback is given, and the sums of each wall.
#include <cmath>
#include <vector>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::CSimulation;

TEST(CWalls, CountHitsAndImpulses) {
  const CSimulation gas(
      "needles = { count = 60, box = 5 }\n[[walls]]\naxis = \"y\"\nside = \"both\"\n");
  ASSERT_EQ(needlework_wall_count(gas), 2u) << gas.error.message;
  std::vector<needlework_happening> seen;
  const auto add = [](const needlework_happening* first, std::size_t count, void* user) {
    auto& all = *static_cast<std::vector<needlework_happening>*>(user);
    all.insert(all.end(), first, first + count);
    return 0;
  };
  EXPECT_EQ(needlework_set_happening_callback(gas, 10, add, &seen), NEEDLEWORK_OK);
  gas.run_to(100);
  EXPECT_EQ(gas.totals().collisions, 100u);
  std::uint64_t hits[2] = {};
  double impulse[2] = {};
  for (const needlework_happening& each : seen) {
    if (each.kind == NEEDLEWORK_KIND_PAIR) continue;
    ASSERT_EQ(each.kind, NEEDLEWORK_KIND_WALL);
    ASSERT_LT(each.event.second, 2u);
    ++hits[each.event.second];
    impulse[each.event.second] += std::abs(each.event.impulse[1]);
    EXPECT_EQ(std::abs(each.event.arm_first), 0.5);
    EXPECT_LT(each.event.normal_velocity, 0);
  }
  for (const std::size_t n : {0u, 1u}) {
    needlework_wall wall{};
    EXPECT_EQ(needlework_get_wall(gas, n, &wall), NEEDLEWORK_OK);
    EXPECT_EQ(wall.axis, 1);
    EXPECT_EQ(wall.high, static_cast<int>(n));
    EXPECT_EQ(wall.hits, hits[n]);
    EXPECT_GT(wall.hits, 5u);
    EXPECT_NEAR(wall.impulse, impulse[n], 1e-12 * impulse[n]);
  }
  needlework_wall none{};
  EXPECT_EQ(needlework_get_wall(gas, 2, &none), NEEDLEWORK_USAGE);
  EXPECT_EQ(gas.message(), "index = 2: expected that of one of 2 walls");
  EXPECT_EQ(needlework_get_wall(gas, 0, nullptr), NEEDLEWORK_USAGE);
}

TEST(CWalls, AreNoneInAPeriodicBox) {
  const CSimulation gas(test::cooling);
  EXPECT_EQ(needlework_wall_count(gas), 0u);
  EXPECT_EQ(needlework_wall_count(nullptr), 0u);
}

}  // namespace
}  // namespace needlework
