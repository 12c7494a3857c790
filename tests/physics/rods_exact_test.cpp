// Exact results of rods of finite width: rates at low density, the law of
// V_n^2 / M_nn at every density, and equipartition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "needlework/simulation.h"
#include "needlework/theory.h"
#include "tests/support/rods.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::agrees;
using test::Mean;
using test::rods_of;
using theory::Temperatures;

// An elastic gas in equilibrium. Law: theory::mixture_rates at T = 2 E / Dof times the value of the
// pair distribution at contact, 1 + n B3 / B2 + ..., which is 1 within 4e-4 at these densities.
// Collisions of a pair that meets again before it has parted count in full, so that runs are long.
struct DiluteCase {
  const char* name;
  std::vector<Species> species;
  double packing;
};

std::vector<DiluteCase> dilute_cases() {
  const auto rods = [](const char* name, double length, double diameter, double mass) {
    return Species{.name = name,
                   .count = 400,
                   .length = length,
                   .mass = mass,
                   .k = length > 0 ? homogeneous_k(length, diameter) : 6,
                   .diameter = diameter};
  };
  return {{"spheres", {rods("spheres", 0, 1, 1)}, 1e-4},
          {"L1", {rods("rods", 1, 1, 1)}, 1e-4},
          {"L5", {rods("rods", 5, 1, 1)}, 1e-4},
          {"L100", {rods("rods", 100, 1, 1)}, 1e-6},
          {"unequal", {rods("a", 3, 1, 1), rods("b", 1, 0.5, 0.4), rods("c", 0, 1.5, 2)}, 1e-4}};
}

void expect_exact_rates(const DiluteCase& which, int runs, double collisions_per_rod,
                        double largest_error) {
  Scene scene;
  scene.species = which.species;
  double body = 0, count = 0, degrees = -3;
  for (const Species& each : scene.species) {
    const double n = static_cast<double>(each.count);
    body += n * each.volume();
    count += n;
    degrees += (each.length > 0 ? 5 : 3) * n;
  }
  const double edge = std::cbrt(body / which.packing), volume = edge * edge * edge;
  scene.needles.box = {edge, edge, edge};
  const Composition composition = scene.composition();
  std::vector<Mean> rates(composition.pairs());
  for (int run = 0; run < runs; ++run) {
    scene.needles.seed = 500 + static_cast<std::uint64_t>(run);
    Simulation gas(scene);
    gas.advance(test::until_collisions(collisions_per_rod));
    const double temperature = 2 * gas.totals().energy * count / degrees;
    std::vector<Temperatures> now;
    for (const Species& each : scene.species) {
      now.push_back({temperature, each.length > 0 ? temperature : 0});
    }
    const auto expected = theory::mixture_rates(composition, volume, now).collisions;
    const auto found = gas.collisions_by_pair();
    for (std::size_t pair = 0; pair < rates.size(); ++pair) {
      rates[pair].add(static_cast<double>(found[pair]) / (expected[pair] * gas.time()));
    }
  }
  for (std::size_t pair = 0; pair < rates.size(); ++pair) {
    EXPECT_TRUE(agrees(rates[pair].measured(), 1, 3.5)) << which.name << ", pair " << pair;
    EXPECT_LT(rates[pair].measured().error, largest_error) << which.name << ", pair " << pair;
  }
}

class DiluteRods : public testing::TestWithParam<DiluteCase> {};

TEST_P(DiluteRods, CollideAtTheExactRates) { expect_exact_rates(GetParam(), 8, 20, 0.04); }

TEST_P(DiluteRods, CollideAtTheExactRatesToThreeThousandths_slow) {
  const bool mixture = GetParam().species.size() > 1;
  expect_exact_rates(GetParam(), mixture ? 60 : 40, 100, mixture ? 0.012 : 0.003);
}

INSTANTIATE_TEST_SUITE_P(Rods, DiluteRods, testing::ValuesIn(dilute_cases()),
                         [](const auto& test) { return std::string(test.param.name); });

// An inelastic gas that has just been drawn, with temperatures of each species: rates of first
// collisions of pairs and changes of both temperatures as by theory::mixture_rates, at a density at
// which the value of the pair distribution at contact is 1 within half a percent.
//
// A run lasts a fiftieth of the time in which rods pass each other. Later, pairs that had met
// before the start are missing, and pairs collide again, which counts as long as velocities are not
// those of an equilibrium: over some times of passing, 15 % more collisions were found.
void expect_exact_start(const std::vector<Species>& species, double packing, int runs) {
  Scene scene;
  scene.species = species;
  scene.collisions.epsilon = 0.7;
  scene.collisions.tc_relative = 1e-6;
  double body = 0, longest = 0;
  for (const Species& each : species) {
    body += static_cast<double>(each.count) * each.volume();
    longest = std::max(longest, each.extent());
  }
  const double edge = std::cbrt(body / packing), time = longest / 50;
  scene.needles.box = {edge, edge, edge};
  const Composition composition = scene.composition();
  std::vector<Temperatures> start;
  for (const Species& each : composition.species()) start.push_back({each.t_tr, each.t_rot});
  const auto rates = theory::mixture_rates(composition, edge * edge * edge, start);
  std::vector<double> first(composition.pairs());
  std::vector<Mean> t_tr(composition.size()), t_rot(composition.size());
  for (int run = 0; run < runs; ++run) {
    scene.needles.seed = 900 + static_cast<std::uint64_t>(run);
    Simulation gas(scene);
    const std::vector<SpeciesIndex> of = composition.in_order_of_id();
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    gas.on_collision([&](const Collision& c) {
      if (!seen.insert({c.first, c.second}).second) return;
      ++first[composition.pair_index(of[c.first], of[c.second])];
    });
    const auto before = gas.species_totals();
    gas.advance(test::until_time(time));
    const auto after = gas.species_totals();
    for (std::size_t n = 0; n < composition.size(); ++n) {
      t_tr[n].add((after[n].t_tr - before[n].t_tr) / time);
      t_rot[n].add((after[n].t_rot - before[n].t_rot) / time);
    }
  }
  for (std::size_t pair = 0; pair < first.size(); ++pair) {
    const double expected = rates.collisions[pair] * time * runs;
    EXPECT_GT(expected, 100) << "pair " << pair;
    EXPECT_NEAR(first[pair], expected, 3.5 * std::sqrt(expected) + 0.01 * expected)
        << "pair " << pair;
  }
  for (std::size_t n = 0; n < composition.size(); ++n) {
    EXPECT_TRUE(agrees(t_tr[n].measured(), rates.temperatures[n].t_tr, 3.5)) << "species " << n;
    EXPECT_TRUE(agrees(t_rot[n].measured(), rates.temperatures[n].t_rot, 3.5)) << "species " << n;
    EXPECT_LT(t_tr[n].measured().error, 0.3 * std::abs(rates.temperatures[n].t_tr) + 1e-3);
  }
}

Species drawn_rods(const char* name, double length, double diameter, double mass, double t_rot,
                   std::uint64_t count) {
  return {.name = name,
          .count = count,
          .length = length,
          .mass = mass,
          .k = length > 0 ? homogeneous_k(length, diameter) : 6,
          .t_tr = 1,
          .t_rot = t_rot,
          .diameter = diameter};
}

TEST(DrawnRods, CollideAndCoolAtTheExactRates) {
  expect_exact_start({drawn_rods("rods", 5, 1, 1, 0.4, 20000)}, 1e-3, 40);
}

TEST(DrawnRods, CollideAndCoolAtTheExactRatesForEveryShape_long) {
  expect_exact_start({drawn_rods("spheres", 0, 1, 1, 0, 20000)}, 1e-3, 100);
  expect_exact_start({drawn_rods("rods", 1, 1, 1, 0.4, 20000)}, 1e-3, 100);
  expect_exact_start({drawn_rods("rods", 5, 1, 1, 0.4, 20000)}, 1e-3, 150);
  expect_exact_start({drawn_rods("rods", 100, 1, 1, 0.4, 20000)}, 5e-6, 100);
  expect_exact_start(
      {drawn_rods("rods", 3, 1, 1, 0.4, 8000), drawn_rods("balls", 0, 1.5, 2, 0, 8000)}, 1e-3, 150);
  expect_exact_start({drawn_rods("a", 3, 1, 1, 0.4, 8000), drawn_rods("b", 1, 0.5, 0.4, 1.7, 8000)},
                     1e-3, 150);
}

// Elastic: by the flux of pairs to contact, V_n^2 / (2 M_nn T) = |V_n dp| / (4 T) has the density
// exp(-x), however the positions are correlated. Energy is fixed, so the mean is 1 - 1 / (Dof + 1)
// of that, and T is 2 E / Dof with Dof = 5 N - 3, of spheres 3 N - 3.
void expect_exponential(double length, double packing, std::uint64_t collisions_per_rod) {
  constexpr std::uint64_t count = 256;
  Simulation gas(rods_of(count, length, packing));
  gas.advance(test::until_collisions(60));
  const double degrees = (length > 0 ? 5.0 : 3.0) * count - 3;
  const double temperature = 2 * gas.totals().energy * count / degrees;
  constexpr int bins = 20;
  std::vector<double> found(bins), expected(bins);
  double sum = 0, number = 0;
  gas.on_collision([&](const Collision& c) {
    const double impulse = std::hypot(c.impulse[0], c.impulse[1], c.impulse[2]);
    const double x = 0.25 * std::abs(c.normal_velocity) * impulse / temperature;
    const auto bin = static_cast<int>(bins * -std::expm1(-x));
    ++found[static_cast<std::size_t>(std::min(bin, bins - 1))];
    sum += x;
    ++number;
  });
  gas.advance(test::until_collisions(static_cast<double>(60 + collisions_per_rod)));
  for (double& each : expected) each = number / bins;
  double chi_square = 0;
  for (int bin = 0; bin < bins; ++bin) {
    const auto n = static_cast<std::size_t>(bin);
    chi_square += (found[n] - expected[n]) * (found[n] - expected[n]) / expected[n];
  }
  // 19 degrees of freedom: 43.8 in one case of 1000.
  EXPECT_LT(chi_square, 43.8) << "L = " << length << ", packing " << packing;
  EXPECT_NEAR(sum / number, degrees / (degrees + 1), 4 / std::sqrt(number))
      << "L = " << length << ", packing " << packing;
}

TEST(RodContacts, HaveExponentialEnergiesAtEveryDensity) {
  for (const auto& [length, packing] :
       {std::pair(5.0, 0.01), std::pair(5.0, 0.2), std::pair(5.0, 0.4), std::pair(0.0, 0.1),
        std::pair(0.0, 0.45), std::pair(1.0, 0.3), std::pair(20.0, 0.05)}) {
    expect_exponential(length, packing, 150);
  }
}

TEST(RodContacts, HaveExponentialEnergiesInMillionsOfCollisions_long) {
  for (const auto& [length, packing] :
       {std::pair(5.0, 0.01), std::pair(5.0, 0.2), std::pair(5.0, 0.4), std::pair(0.0, 0.45)}) {
    expect_exponential(length, packing, 4000);
  }
}

// All temperatures of an elastic mixture become T = 2 E / Dof, where each rod has five degrees of
// freedom and each sphere three, less three; translations of a mass m have 1 - m / (sum of masses)
// of that, as the momentum is 0.
TEST(RodMixture, SharesItsEnergyEqually) {
  constexpr double spheres = 80, rods = 160;
  Mean sphere_t_tr, rod_t_tr, rod_t_rot;
  double temperature = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Scene scene = test::rods_and_spheres(80, 11, seed);
    scene.collisions.epsilon = 1;
    scene.collisions.tc = {};
    Simulation gas(scene);
    const double degrees = 5 * rods + 3 * spheres - 3;
    temperature = 2 * gas.totals().energy * (spheres + rods) / degrees;
    EXPECT_NEAR(gas.species_totals()[1].t_rot, 0.5, 1e-9);
    gas.advance(test::until_collisions(60));
    Mean of_run[3];
    for (int n = 1; n <= 40; ++n) {
      gas.advance(test::until_collisions(60 + 4 * n));
      const auto now = gas.species_totals();
      of_run[0].add(now[0].t_tr);
      of_run[1].add(now[1].t_tr);
      of_run[2].add(now[1].t_rot);
      ASSERT_EQ(now[0].t_rot, 0);
    }
    sphere_t_tr.add(of_run[0].measured().value / temperature);
    rod_t_tr.add(of_run[1].measured().value / temperature);
    rod_t_rot.add(of_run[2].measured().value / temperature);
  }
  const double mass = 2 * spheres + rods;
  EXPECT_TRUE(agrees(sphere_t_tr.measured(), 1 - 2 / mass, 3.5));
  EXPECT_TRUE(agrees(rod_t_tr.measured(), 1 - 1 / mass, 3.5));
  EXPECT_TRUE(agrees(rod_t_rot.measured(), 1, 3.5));
  for (const Mean* each : {&sphere_t_tr, &rod_t_tr, &rod_t_rot})
    EXPECT_LT(each->measured().error, 0.02);
}

}  // namespace
}  // namespace needlework
