// Lengths and masses of a species enter everywhere by the table, and nowhere as a unit of 1.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>

#include "needlework/simulation.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

// A length of 2^p and a mass of 4^q.
struct Powers {
  int p, q;
};

class SpeciesOfPowersOfTwo
    : public testing::TestWithParam<std::tuple<Powers, const char*, const char*>> {};

Scene rough_cooling_gas(double density) {
  Scene scene =
      test::inelastic(test::scene_of(120, std::cbrt(120 / density), 11), 0.85, 1e-3, 0.25);
  return scene;
}

// Everything in an event scales by exact powers of two, so no rounding differs: every bit is the
// same but for that factor. A margin or tolerance that took a length for 1 would change some.
TEST_P(SpeciesOfPowersOfTwo, HaveTheSameEventsRescaled) {
  const auto [powers, search, accuracy] = GetParam();
  for (const double density : {0.5, 8.0}) {
    Scene scene = rough_cooling_gas(density);
    scene.engine.search = search;
    scene.engine.accuracy = accuracy;
    const double length = std::ldexp(1.0, powers.p), mass = std::ldexp(1.0, 2 * powers.q);
    const test::Recorded unit = test::record(scene, 1500);
    const test::Recorded scaled = test::record(test::with_species(scene, length, mass), 1500);
    const double time = std::ldexp(1.0, powers.p + powers.q);
    const double velocity = std::ldexp(1.0, -powers.q), momentum = std::ldexp(1.0, powers.q);
    ASSERT_EQ(unit.collisions.size(), scaled.collisions.size());
    EXPECT_GT(unit.totals.tc_collisions, 0u);
    EXPECT_EQ(unit.totals.tc_collisions, scaled.totals.tc_collisions);
    EXPECT_EQ(unit.totals.energy, scaled.totals.energy);
    EXPECT_EQ(unit.totals.t_rot, scaled.totals.t_rot);
    EXPECT_EQ(unit.epoch_length * time, scaled.epoch_length);
    for (std::size_t n = 0; n < unit.collisions.size(); ++n) {
      const Collision &a = unit.collisions[n], &b = scaled.collisions[n];
      SCOPED_TRACE("collision " + std::to_string(n));
      ASSERT_EQ(a.first, b.first);
      ASSERT_EQ(a.second, b.second);
      ASSERT_EQ(a.shift, b.shift);
      ASSERT_EQ(a.epoch, b.epoch);
      ASSERT_EQ(a.offset * time, b.offset);
      ASSERT_EQ(a.arm_first * length, b.arm_first);
      ASSERT_EQ(a.arm_second * length, b.arm_second);
      ASSERT_EQ(a.sin_angle, b.sin_angle);
      ASSERT_EQ(a.normal_velocity * velocity, b.normal_velocity);
      ASSERT_EQ(a.energy_change, b.energy_change);
      ASSERT_EQ(a.contact_time_rule, b.contact_time_rule);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(a.impulse[axis] * momentum, b.impulse[axis]);
        ASSERT_EQ(a.after[0].position[axis] * length, b.after[0].position[axis]);
      }
    }
  }
}

std::string name_of(const testing::TestParamInfo<SpeciesOfPowersOfTwo::ParamType>& info) {
  const auto [powers, search, accuracy] = info.param;
  std::string out = std::string(search) + "_" + accuracy + "_" + std::to_string(info.index);
  for (char& c : out) c = c == '-' ? '_' : c;
  return out;
}

INSTANTIATE_TEST_SUITE_P(EverySearch, SpeciesOfPowersOfTwo,
                         testing::Combine(testing::Values(Powers{1, 0}, Powers{-3, 2}),
                                          testing::Values("all-pairs", "linked-lists",
                                                          "linked-cells", "capsules"),
                                          testing::Values("standard")),
                         name_of);
INSTANTIATE_TEST_SUITE_P(
    EveryAccuracy, SpeciesOfPowersOfTwo,
    testing::Combine(testing::Values(Powers{0, 5}, Powers{17, -40}, Powers{-18, 60}),
                     testing::Values("auto"), testing::Values("fast", "standard", "rigorous")),
    name_of);

}  // namespace
}  // namespace needlework
