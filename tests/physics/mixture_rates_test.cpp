// From a random state, any mixture collides and cools at the exact rates, at every density.
//
// Law: centres and directors uniform, velocities Gaussian with temperatures of each species: at
// that instant collisions of each two species and changes of each temperature have the rates of
// theory::mixture_rates. Drawn states have zero momentum: P / M is taken off every velocity, which
// leaves relative motion and so the rates exact, and shifts the exchange of energy by 1/N.
//
// A run lasts a small part of a mean free time, over which theory::mixture_cooling gives the drift
// of the rates well enough to take it off.
// Tolerance: 3 standard errors, from the scatter of the runs, each with a seed of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <set>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/theory.h"
#include "tests/support/runs.h"
#include "tests/support/statistics.h"

namespace needlework {
namespace {

using test::Mean;
using theory::Temperatures;

struct Mixture {
  const char* name;
  std::vector<Species> species;
  std::vector<Scene::Pair> pairs;
  Restitution rule;
  double side;
  double duration;  ///< in mean free times of the species with the shortest one
  int runs;
  std::uint64_t seed;
};

std::ostream& operator<<(std::ostream& out, const Mixture& m) { return out << m.name; }

class MixtureAtTheStart : public testing::TestWithParam<Mixture> {};

TEST_P(MixtureAtTheStart, HasExactRates) {
  const Mixture mixture = GetParam();
  Scene scene = test::scene_of(0, mixture.side, mixture.seed);
  scene.species = mixture.species;
  scene.pairs = mixture.pairs;
  scene.collisions.epsilon = mixture.rule.epsilon;
  scene.collisions.beta = mixture.rule.beta;
  const Composition composition = scene.composition();
  const double volume = mixture.side * mixture.side * mixture.side;
  const std::size_t kinds = composition.size(), pairs = composition.pairs();
  std::vector<Temperatures> start;
  for (const Species& each : composition.species()) start.push_back({each.t_tr, each.t_rot});
  const auto rates = theory::mixture_rates(composition, volume, start);
  // A part of the mean free time of the species that collides most often.
  double fastest = 0;
  for (std::size_t a = 0; a < kinds; ++a) {
    double collisions = 0;
    for (std::size_t b = 0; b < kinds; ++b) {
      collisions += (a == b ? 2 : 1) * rates.collisions[composition.pair_index(a, b)];
    }
    fastest = std::max(fastest, collisions / static_cast<double>(composition[a].count));
  }
  const double time = mixture.duration / fastest;

  // By how much the mean over the run differs from the rate at its start.
  const std::array times = {time / 2, time};
  const auto course = theory::mixture_cooling(composition, volume, start, times);
  const auto halfway = theory::mixture_rates(composition, volume, course[0]);

  std::vector<Mean> collisions(pairs), t_tr(kinds), t_rot(kinds);
  int left_out = 0;
  for (int run = 0; run < mixture.runs; ++run, ++scene.needles.seed) {
    Simulation simulation(scene);
    // Two needles that have collided often do so again at once, which is not part of the rate.
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    std::vector<double> first(pairs);
    const std::vector<SpeciesIndex> species = composition.in_order_of_id();
    simulation.on_collision([&](const Collision& c) {
      if (!seen.insert({c.first, c.second}).second) return;
      ++first[composition.pair_index(species[c.first], species[c.second])];
    });
    const auto before = simulation.species_totals();
    Scene::Until until = test::until_time(time);
    until.collisions_per_needle = 1;  // a pair that collapses would bounce on and on
    Stop stop = Stop::collisions;
    try {
      stop = simulation.advance(until);
    } catch (const InvalidStateError&) {
    }
    if (stop != Stop::time) {
      ++left_out;
      continue;
    }
    const auto after = simulation.species_totals();
    for (std::size_t n = 0; n < pairs; ++n) collisions[n].add(first[n] / time);
    for (std::size_t n = 0; n < kinds; ++n) {
      t_tr[n].add((after[n].t_tr - before[n].t_tr) / time);
      t_rot[n].add((after[n].t_rot - before[n].t_rot) / time);
    }
  }
  EXPECT_LE(left_out, mixture.runs / 100);
  for (std::size_t n = 0; n < pairs; ++n) {
    std::cout << "pair " << n << ": " << collisions[n].measured() / halfway.collisions[n] << '\n';
    EXPECT_TRUE(test::agrees(collisions[n].measured(), halfway.collisions[n], 3)) << "pair " << n;
    EXPECT_LT(collisions[n].measured().error, 0.02 * halfway.collisions[n]);
  }
  for (std::size_t n = 0; n < kinds; ++n) {
    const Temperatures change{(course[1][n].t_tr - start[n].t_tr) / time,
                              (course[1][n].t_rot - start[n].t_rot) / time};
    std::cout << "species " << n << ": T_tr' " << t_tr[n].measured() << " of " << change.t_tr
              << ", T_rot' " << t_rot[n].measured() << " of " << change.t_rot << '\n';
    EXPECT_TRUE(test::agrees(t_tr[n].measured(), change.t_tr, 3)) << "species " << n;
    EXPECT_TRUE(test::agrees(t_rot[n].measured(), change.t_rot, 3)) << "species " << n;
  }
}

// Counts such that each pair of species has its share of the collisions.
INSTANTIATE_TEST_SUITE_P(
    Smooth, MixtureAtTheStart,
    testing::Values(
        Mixture{
            "odd",
            {{.name = "a", .count = 600, .length = 1, .mass = 1, .k = 6, .t_tr = 1, .t_rot = 0.4},
             {.name = "b",
              .count = 1000,
              .length = 0.6,
              .mass = 2.5,
              .k = 3,
              .t_tr = 0.5,
              .t_rot = 1.7}},
            {},
            {0.7, -1},
            9,
            0.05,
            800,
            1000},
        Mixture{
            "dense_1_to_10_long",
            {{.name = "a", .count = 150, .length = 3, .mass = 20, .k = 6, .t_tr = 2, .t_rot = 1},
             {.name = "b",
              .count = 1500,
              .length = 0.3,
              .mass = 0.5,
              .k = 2,
              .t_tr = 1,
              .t_rot = 0}},
            {{.between = {"a", "a"}, .epsilon = 1, .beta = {}}},
            {0.8, -1},
            7,
            0.2,
            800,
            50000}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Rough, MixtureAtTheStart,
    testing::Values(Mixture{
        "three_long",
        {{.name = "a", .count = 500, .length = 1, .mass = 1, .k = 6, .t_tr = 1, .t_rot = 0.4},
         {.name = "b", .count = 1000, .length = 0.5, .mass = 3, .k = 3, .t_tr = 4, .t_rot = 2},
         {.name = "c", .count = 300, .length = 1.7, .mass = 1, .k = 10, .t_tr = 1, .t_rot = 2}},
        {{.between = {"a", "c"}, .epsilon = 0.9, .beta = 1},
         {.between = {"b", "b"}, .epsilon = {}, .beta = -1}},
        {0.8, 0.3},
        9,
        0.08,
        1500,
        90000}),
    [](const auto& info) { return std::string(info.param.name); });

// Law: in elastic equilibrium collisions of each two species have the rates of
// theory::mixture_rates at T = 2 E / (5 N - 3) for all freedoms (zero momentum takes T m / M off
// T_tr, and gives velocities of two needles a correlation that puts it back into their relative
// velocity), at any density, times the factor of a fixed energy, 1 - 1/(4 D) with D = 5 N - 3.
// Tolerance: 3 standard errors of batches of a run, at most 0.3 %.
TEST(ElasticMixture, CollidesAtTheExactRates_long) {
  Scene scene = test::scene_of(0, 9, 17);
  scene.species = {{.name = "a", .count = 600, .length = 1, .mass = 1, .k = 6},
                   {.name = "b", .count = 1000, .length = 0.6, .mass = 2.5, .k = 3}};
  Simulation simulation(scene);
  const Composition composition = scene.composition();
  const double freedoms = 5.0 * 1600 - 3, t = 2 * simulation.totals().energy * 1600 / freedoms;
  const std::array<Temperatures, 2> equal = {Temperatures{t, t}, Temperatures{t, t}};
  const auto rates = theory::mixture_rates(composition, 9.0 * 9 * 9, equal);
  std::array<Mean, 3> found;
  double time = 0;
  std::vector<std::uint64_t> before(3);
  constexpr int batches = 300;
  for (int batch = 0; batch < batches; ++batch) {
    time += 4 * simulation.mean_free_time();
    const double start = simulation.time();
    simulation.advance(test::until_time(time));
    const auto now = simulation.collisions_by_pair();
    for (std::size_t n = 0; n < 3; ++n) {
      found[n].add(static_cast<double>(now[n] - before[n]) / (simulation.time() - start));
    }
    before = now;
  }
  for (std::size_t n = 0; n < 3; ++n) {
    const double exact = rates.collisions[n] * (1 - 1 / (4 * freedoms));
    std::cout << "pair " << n << ": " << found[n].measured() / exact << '\n';
    EXPECT_TRUE(test::agrees(found[n].measured(), exact, 3)) << "pair " << n;
    EXPECT_LT(found[n].measured().error, 0.003 * exact);
  }
}

// Law: T_rot of each species is T, T_tr is T (1 - m / M) with M the mass of all needles and
// T = 2 E / (5 N - 3), at any density. Tolerance: 3.5 standard errors of batches.
TEST(ElasticMixture, GoesToEquipartition) {
  Scene scene = test::scene_of(0, 4.2, 5);
  scene.species = {
      {.name = "a", .count = 12, .length = 2, .mass = 10, .k = 6, .t_tr = 3, .t_rot = 0},
      {.name = "b", .count = 60, .length = 0.8, .mass = 1, .k = 2, .t_tr = 0.5, .t_rot = 1}};
  Simulation simulation(scene);
  double mass = 0;
  for (const Species& each : scene.species) mass += static_cast<double>(each.count) * each.mass;
  const double count = 72;
  const double t = 2 * simulation.totals().energy * count / (5 * count - 3);
  std::array<Mean, 2> t_tr, t_rot;
  double per_needle = 100;
  simulation.advance(test::until_collisions(per_needle));  // to equilibrium
  for (int batch = 0; batch < 200; ++batch) {
    std::array<double, 2> tr{}, rot{};
    constexpr int samples = 20;
    for (int n = 0; n < samples; ++n) {
      per_needle += 2;
      simulation.advance(test::until_collisions(per_needle));
      const auto totals = simulation.species_totals();
      for (std::size_t s = 0; s < 2; ++s) {
        tr[s] += totals[s].t_tr / samples;
        rot[s] += totals[s].t_rot / samples;
      }
    }
    for (std::size_t s = 0; s < 2; ++s) {
      t_tr[s].add(tr[s]);
      t_rot[s].add(rot[s]);
    }
  }
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_TRUE(test::agrees(t_tr[s].measured(), t * (1 - scene.species[s].mass / mass), 3.5));
    EXPECT_TRUE(test::agrees(t_rot[s].measured(), t, 3.5));
    EXPECT_LT(t_tr[s].measured().error, 0.01 * t);
  }
}

}  // namespace
}  // namespace needlework
