// Conditions that end an advance, counted from the start and from the present.
#include "src/runs/limits.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "needlework/error.h"
#include "tests/support/runs.h"

namespace needlework::runs {
namespace {

Simulation cooling_gas() {
  Scene scene = test::scene_of(50, 5);
  scene.collisions.epsilon = 0.8;
  return Simulation(scene);
}

// For 49 needles 2 n / 49 * 49 / 2 is not always n in double.
TEST(Limits, AnyNumberOfCollisionsIsMetExactly) {
  Simulation simulation(test::scene_of(49, 5));
  for (std::uint64_t n = 1; n <= 200; ++n) {
    simulation.advance(from_now({.collisions = 1}, simulation));
    ASSERT_EQ(simulation.collisions(), n);
  }
}

// Also where rounding has moved the energy by account away from that of the needles.
TEST(Limits, AreMetAtOnceByTheEnergyThatThereIs) {
  for (const double epsilon : {0.8, 1.0}) {
    Scene scene = test::scene_of(50, 5);
    scene.collisions.epsilon = epsilon;
    Simulation simulation(scene);
    for (std::uint64_t n = 1; n <= 40; ++n) {
      simulation.advance(from_now({.collisions = 3}, simulation));
      EXPECT_EQ(simulation.advance(from_now({.energy_ratio = 1}, simulation)), Stop::energy);
      EXPECT_EQ(simulation.collisions(), 3 * n);
    }
  }
}

TEST(Limits, OfEnergyNeedAnEnergyAtTheStart) {
  Scene scene = test::scene_of(50, 5);
  scene.initial.t_tr = scene.initial.t_rot = 0;
  Simulation simulation(scene);
  const State moving = Simulation(test::scene_of(50, 5)).copy();
  simulation.set_velocities(moving.velocity, moving.angular_velocity);
  EXPECT_THROW(from_now({.energy_ratio = 0.5}, simulation), InputError);
  EXPECT_THROW(from_start({.energy_ratio = 1}, simulation), InputError);
}

TEST(Limits, MayBeInfinite) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Simulation simulation = cooling_gas();
  EXPECT_EQ(simulation.advance(from_now({.energy_ratio = infinity}, simulation)), Stop::energy);
  const std::vector<std::array<double, 3>> none(50);
  simulation.set_velocities(none, none);
  for (const double ratio : {0.5, infinity}) {
    EXPECT_EQ(simulation.advance(from_now({.energy_ratio = ratio}, simulation)),
              Stop::nothing_can_happen);
  }
}

}  // namespace
}  // namespace needlework::runs
