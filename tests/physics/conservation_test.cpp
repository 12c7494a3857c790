// Quantities that collisions conserve stay constant to rounding over many collisions.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "tests/support/runs.h"

namespace needlework {
namespace {

// Law: momentum is conserved by every collision, energy by elastic ones (epsilon = 1, beta = -1 or
// 1). Each collision errs by a rounding of about 1e-16 of the two needles' share, and errors add up
// like a random walk: 1e5 collisions of 200 needles should stay below 1e-13; 1e-12 is allowed.
class Conservation : public testing::TestWithParam<double> {};

TEST_P(Conservation, EnergyAndMomentumDoNotDrift) {
  Scene scene = test::scene_of(200, 6.5, 77);
  scene.collisions.beta = GetParam();
  SCOPED_TRACE(test::name_of(scene));
  Simulation simulation(scene);
  const Totals before = simulation.totals();
  Scene::Until until;
  until.collisions_per_needle = 1000;
  simulation.advance(until);
  const Totals after = simulation.totals();
  ASSERT_GE(after.collisions, 100000u);

  const double energy_drift = std::abs(after.energy / before.energy - 1);
  const double momentum_unit = 200 * std::sqrt(3 * before.t_tr);  // sum of the |m v|
  double momentum_drift = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double change = std::abs(after.momentum[axis] - before.momentum[axis]);
    momentum_drift = std::max(momentum_drift, change / momentum_unit);
  }
  std::cout << "drift of energy " << energy_drift << ", of momentum " << momentum_drift << '\n';
  EXPECT_LT(energy_drift, 1e-12);
  EXPECT_LT(momentum_drift, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Elastic, Conservation, testing::Values(-1, 1));

}  // namespace
}  // namespace needlework
