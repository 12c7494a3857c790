// Elastic needles in equilibrium collide at the exact rate, at every density.
//
// Law: infinitely thin needles exclude no volume, so in equilibrium centres and directors are those
// of an ideal gas, and the rate per needle is n (sqrt(pi)/2) sqrt(T) times the integral of
// sqrt(1 + k r^2) over the unit square (the flux of the contact points through each other, averaged
// over Gaussian velocities); with momentum 0 and energy fixed, the finite number of needles enters
// by way of the microcanonical ensemble (theory::equilibrium_rate).
// Tolerance: 3 standard errors, from the scatter of runs with different seeds; batches of one run
// would be correlated in a dense gas, where density waves decay slowly. The error itself is at most
// 0.3 % of the rate, in builds without optimisation 0.5 %.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>

#include "needlework/theory.h"
#include "tests/support/by_build.h"
#include "tests/support/parameter_name.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::Mean;
using test::Measured;

constexpr double collisions = test::by_build(5e5, 1.5e5);
constexpr double largest_error = test::by_build(0.003, 0.005);
constexpr int runs = 40;

// Collisions per needle and unit time over the exact rate, from `runs` runs of about `collisions`
// collisions in all. A drawn state is one of the equilibrium, so none has to settle.
Measured rate_over_exact(Scene scene, double length, double mass) {
  const double time_unit = length * std::sqrt(mass);
  const double count = static_cast<double>(scene.needles.count);
  const auto& box = scene.needles.box;
  Mean ratio;
  for (int run = 0; run < runs; ++run, ++scene.needles.seed) {
    Simulation simulation(scene);
    const double volume = box[0] * box[1] * box[2] / (length * length * length);
    const double exact = theory::equilibrium_rate(count, volume, simulation.totals().energy * count,
                                                  scene.needles.k) /
                         time_unit;
    Scene::Until until;
    until.time = collisions / runs / (exact * count / 2);
    simulation.advance(until);
    const double measured = static_cast<double>(simulation.totals().collisions);
    ratio.add(measured / (collisions / runs));
  }
  return ratio.measured();
}

struct ElasticGas {
  double k;
  double density;
  std::uint64_t count;
  std::uint64_t seed;  ///< of the first run; the others follow
  double beta = -1;
  double length = 1, mass = 1;
};

std::ostream& operator<<(std::ostream& out, const ElasticGas& gas) {
  return out << "k " << gas.k << ", density " << gas.density << ", " << gas.count
             << " needles, beta " << gas.beta << ", length " << gas.length << ", mass " << gas.mass
             << ", seed " << gas.seed;
}

std::string name_of(const testing::TestParamInfo<ElasticGas>& info) {
  return test::parameter_name({{"k", info.param.k}, {"n", info.param.density}});
}

class ElasticRate : public testing::TestWithParam<ElasticGas> {};

TEST_P(ElasticRate, IsExactInEquilibrium) {
  const ElasticGas gas = GetParam();
  SCOPED_TRACE(gas);
  Scene scene = test::scene_of(gas.count, std::cbrt(gas.count / gas.density), gas.seed);
  scene.needles.k = gas.k;
  scene.collisions.beta = gas.beta;
  if (gas.length != 1 || gas.mass != 1) scene = test::with_species(scene, gas.length, gas.mass);
  const Measured ratio = rate_over_exact(scene, gas.length, gas.mass);
  std::cout << "rate / exact: " << ratio << '\n';
  EXPECT_TRUE(test::agrees(ratio, 1, 3));
  EXPECT_LT(ratio.error, largest_error);
}

// The ends of the ranges of densities and k are long tests, what lies between them slow ones.
INSTANTIATE_TEST_SUITE_P(Smooth, ElasticRate, testing::Values(ElasticGas{20, 3, 500, 1100}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Smooth_long, ElasticRate,
                         testing::Values(ElasticGas{2, 0.72, 500, 200}, ElasticGas{2, 20, 200, 400},
                                         ElasticGas{6, 0.1, 500, 500},
                                         ElasticGas{6, 0.72, 500, 600},
                                         ElasticGas{6, 100, 1000, 1600},
                                         ElasticGas{20, 0.1, 500, 900}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Smooth_slow, ElasticRate,
                         testing::Values(ElasticGas{2, 0.1, 500, 100}, ElasticGas{2, 3, 500, 300},
                                         ElasticGas{6, 3, 500, 700}, ElasticGas{6, 20, 200, 800},
                                         ElasticGas{6, 50, 500, 1500},
                                         ElasticGas{20, 0.72, 500, 1000},
                                         ElasticGas{20, 20, 200, 1200}),
                         name_of);

// Of other lengths and masses, whose species are looked up in a table.
INSTANTIATE_TEST_SUITE_P(OfLengthAndMass_long, ElasticRate,
                         testing::Values(ElasticGas{6, 0.72, 500, 1700, -1, 0.37, 2.9},
                                         ElasticGas{2, 20, 200, 1800, 1, 13.7, 0.083}),
                         name_of);

// Perfectly rough needles (beta = +1) conserve energy too, and their equilibrium is the same.
INSTANTIATE_TEST_SUITE_P(Rough_long, ElasticRate,
                         testing::Values(ElasticGas{6, 0.72, 500, 1300, 1},
                                         ElasticGas{6, 3, 500, 1400, 1}),
                         name_of);

}  // namespace
}  // namespace needlework
