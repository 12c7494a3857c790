// Exact results for equilibrium hold for a few needles, with their finite-N terms.
//
// Laws, for the microcanonical ensemble with momentum 0 (3 (N - 1) translational and 2 N
// rotational degrees of freedom): the rate is theory::equilibrium_rate, and T_tr / T_rot is (N -
// 1) / N. Tolerance: 3 standard errors, from the scatter of batches, each more than 100 mean free
// times long. The values for infinitely many needles must be far outside, so that the test is
// sensitive to these terms.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "needlework/theory.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::Mean;
using test::Measured;

struct Averages {
  Measured rate, t_tr, t_rot;
};

constexpr int batches = 100;
constexpr double collisions = 1.2e5;

// Time averages of a run, the temperatures sampled twice per mean free time.
Averages averages(const Scene& scene) {
  const double count = static_cast<double>(scene.needles.count);
  Simulation simulation(scene);
  const double step = simulation.mean_free_time() / 2;
  const int samples = static_cast<int>(4 * collisions / count / batches);
  Mean rate, t_tr, t_rot;
  std::uint64_t before = 0;
  int steps = 0;
  for (int batch = 0; batch < batches; ++batch) {
    double batch_tr = 0, batch_rot = 0;
    Totals totals;
    for (int sample = 0; sample < samples; ++sample) {
      Scene::Until until;
      until.time = ++steps * step;
      simulation.advance(until);
      totals = simulation.totals();
      batch_tr += totals.t_tr / samples;
      batch_rot += totals.t_rot / samples;
    }
    rate.add(2 * static_cast<double>(totals.collisions - before) / (count * samples * step));
    before = totals.collisions;
    t_tr.add(batch_tr);
    t_rot.add(batch_rot);
  }
  return {rate.measured(), t_tr.measured(), t_rot.measured()};
}

class FiniteCount : public testing::TestWithParam<std::uint64_t> {};

TEST_P(FiniteCount, RateAndTemperaturesAreExact) {
  const double count = static_cast<double>(GetParam());
  const double side = 2.5;
  const double volume = side * side * side;
  const Scene scene = test::scene_of(GetParam(), side, 2024);
  SCOPED_TRACE(test::name_of(scene));
  const Averages run = averages(scene);

  const double energy = 2.5 * count;
  const Measured rate = run.rate / theory::equilibrium_rate(count, volume, energy, scene.needles.k);
  const Measured t_rot = run.t_rot / (energy / (2.5 * count - 1.5));
  const Measured t_tr = run.t_tr / ((energy / (2.5 * count - 1.5)) * (count - 1) / count);
  std::cout << "rate / exact: " << rate << ", T_tr: " << t_tr << ", T_rot: " << t_rot << '\n';
  EXPECT_TRUE(test::agrees(rate, 1, 3));
  EXPECT_TRUE(test::agrees(t_tr, 1, 3));
  EXPECT_TRUE(test::agrees(t_rot, 1, 3));

  // Energy is conserved, so the two temperatures are fully correlated.
  EXPECT_NEAR(run.t_tr.value / run.t_rot.value, (count - 1) / count,
              3 * (run.t_tr.error + run.t_rot.error));
  const double infinite = theory::collision_rate(count / volume, {1, 1}, scene.needles.k);
  EXPECT_FALSE(test::agrees(run.rate, infinite, 5));
  EXPECT_FALSE(test::agrees(run.t_rot, 1, 5));
}

INSTANTIATE_TEST_SUITE_P(Needles, FiniteCount, testing::Values(6, 24));

}  // namespace
}  // namespace needlework
