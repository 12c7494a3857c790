// The direct simulation of the Boltzmann equation of mixtures: exact at its start, where velocities
// are Gaussian, and that of one species where all are alike.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "needlework/boltzmann.h"
#include "src/observe/forecast.h"
#include "tests/support/message_of.h"

namespace needlework::boltzmann {
namespace {

Composition unlike_species() {
  Composition out(
      {{.name = "long", .count = 1, .length = 2, .mass = 5, .k = 2, .t_tr = 3, .t_rot = 0.5},
       {.name = "short", .count = 3, .length = 0.7, .t_rot = 4},
       {.name = "cold", .count = 2, .mass = 0.3, .k = 4, .t_tr = 0, .t_rot = 0}},
      {});
  out.set_restitution(0, 0, {0.5, -1});
  out.set_restitution(0, 1, {0.9, 0.3});
  out.set_restitution(1, 1, {0.8, -1});
  out.set_restitution(1, 2, {0.7, -0.5});
  return out;
}

/// Species of needles of length 1 and mass 1 that differ in their names only.
Composition alike_species(const std::vector<std::uint64_t>& counts, const theory::Gas& gas,
                          const theory::Temperatures& initial) {
  std::vector<Species> species;
  for (const std::uint64_t count : counts) {
    Species each = one_species(gas, initial)[0];
    each.name = std::to_string(species.size());
    each.count = count;
    species.push_back(each);
  }
  return {std::move(species), {gas.epsilon, gas.beta}};
}

// Changes over a time so short that the rates of the theory hold, and half of it: the part that is
// of second order drops out.
TEST(BoltzmannOfMixtures, BeginsAsKineticTheorySays) {
  const Composition composition = unlike_species();
  const double tau = 0.1, time = tau / theory_time_scale(1);
  const Settings settings{.composition = composition, .needles = 1'500'000};
  const Result result = simulate(settings, std::array{tau / 2, tau}, 2);
  Composition many = composition;
  std::vector<theory::Temperatures> initial;
  for (std::size_t n = 0; n < many.size(); ++n) {
    many.set_count(n, 250'000 * many[n].count);
    initial.push_back({many[n].t_tr, many[n].t_rot});
  }
  const auto count = static_cast<double>(many.count());
  const theory::MixtureRates rates = theory::mixture_rates(many, count, initial);

  const auto expect_rate = [&](double at_0, const Measured& half, const Measured& whole,
                               double rate, const std::string& name) {
    const double slope = (4 * (half.value - at_0) - (whole.value - at_0)) / time;
    const double error = (4 * half.error + whole.error) / time;
    EXPECT_NEAR(slope, rate, 3 * error) << name;
    EXPECT_LT(error, 0.1 * std::abs(rate)) << name;
  };
  const Sample &half = result.samples[0], &whole = result.samples[1];
  for (std::size_t n = 0; n < many.size(); ++n) {
    const Means &a = half.species[n], &b = whole.species[n];
    expect_rate(initial[n].t_tr, a.t_tr, b.t_tr, rates.temperatures[n].t_tr, many[n].name);
    expect_rate(initial[n].t_rot, a.t_rot, b.t_rot, rates.temperatures[n].t_rot, many[n].name);
  }
  for (std::size_t pair = 0; pair < many.pairs(); ++pair) {
    // Those that do not move meet no other.
    if (pair == many.pair_index(2, 2)) continue;
    expect_rate(0, half.collisions_between[pair], whole.collisions_between[pair],
                rates.collisions[pair] / count, std::to_string(pair));
  }
}

TEST(BoltzmannOfMixtures, AlikeSpeciesAreOneSpecies) {
  const theory::Gas gas{6, 0.8, 0.2};
  const theory::Temperatures initial{1, 0.4};
  for (const Pairs pairs : {Pairs::single, Pairs::encounters}) {
    const auto after = [&](const Composition& composition, std::uint64_t seed) {
      return simulate({.composition = composition, .pairs = pairs, .needles = 48'000, .seed = seed},
                      std::array{2.0}, 2)
          .samples[0];
    };
    const Sample one = after(one_species(gas, initial), 1);
    const Sample two = after(alike_species({1, 3}, gas, initial), 2);
    const auto expect_same = [](const Measured& a, const Measured& b) {
      EXPECT_NEAR(a.value, b.value, 4 * std::hypot(a.error, b.error));
    };
    for (const Means& means : {static_cast<const Means&>(two), two.species[0], two.species[1]}) {
      expect_same(means.t_tr, one.t_tr);
      expect_same(means.t_rot, one.t_rot);
      expect_same(means.collisions, one.collisions);
      expect_same(means.excess_mixed, one.excess_mixed);
    }
    EXPECT_LT(two.species[0].t_rot.error, 0.02);
    const double all = two.collisions.value / 2;
    for (const auto& [pair, share] : {std::pair(0, 1 / 16.0), {1, 6 / 16.0}, {2, 9 / 16.0}}) {
      const Measured& measured = two.collisions_between[pair];
      EXPECT_NEAR(measured.value, share * all, 4 * measured.error) << pair;
    }
  }
}

// In elastic equilibrium a film may be run backwards: as many contacts are not the first of their
// encounter as are not the last.
TEST(BoltzmannOfMixtures, EncountersOfAnEquilibriumMayBeRunBackwards) {
  const Composition composition(
      {{.name = "long", .count = 1, .length = 3, .mass = 4}, {.name = "short", .count = 3, .k = 2}},
      {});
  const Result result =
      simulate({.composition = composition, .pairs = Pairs::encounters}, std::array{1.0}, 2);
  const auto of = static_cast<double>(result.encounters);
  const double collisions = result.samples[0].collisions.value * 16000;
  const double share = static_cast<double>(result.met_before) /
                       static_cast<double>(result.met_before + result.encounters);
  EXPECT_NEAR(share, 1 - of / collisions, 4 * std::sqrt(2 * share / of));
  EXPECT_GT(share, 0.05);
  EXPECT_GT(of, 1e4);
}

TEST(BoltzmannOfMixtures, ElasticOnesKeepTheirEnergyAndShareItEqually) {
  const Composition composition(
      {{.name = "long", .count = 1, .length = 2, .mass = 5, .k = 2, .t_tr = 3, .t_rot = 0},
       {.name = "short", .count = 3, .length = 0.7, .t_rot = 2}},
      {});
  for (const Pairs pairs : {Pairs::single, Pairs::encounters}) {
    const Sample sample =
        simulate({.composition = composition, .pairs = pairs, .needles = 8000}, std::array{25.0}, 2)
            .samples[0];
    EXPECT_NEAR(sample.energy.value, (4.5 + 3 * 3.5) / 4, 1e-10);
    for (const Means& means : sample.species) {
      EXPECT_NEAR(means.t_tr.value, 1.5, 4 * means.t_tr.error);
      EXPECT_NEAR(means.t_rot.value, 1.5, 4 * means.t_rot.error);
      EXPECT_LT(means.t_tr.error, 0.05);
    }
  }
}

TEST(BoltzmannOfMixtures, DependsOnItsSeedAndNotOnThreads) {
  Settings settings{.composition = unlike_species(), .needles = 640, .seed = 7};
  const auto energy = [&](int threads) {
    return simulate(settings, std::array{0.5, 1.0}, threads).samples[1].species[2].energy.value;
  };
  const double once = energy(1);
  EXPECT_EQ(energy(3), once);
  settings.seed = 8;
  EXPECT_NE(energy(1), once);
}

TEST(BoltzmannOfMixtures, RefusesWhatItCannotFollow) {
  const auto message = [](std::vector<Species> species, std::uint64_t needles = 32000) {
    return test::message_of<std::invalid_argument>([&] {
      simulate({.composition = Composition(species, {}), .needles = needles}, std::array{1.0});
    });
  };
  const Species thin{.name = "thin", .count = 9};
  EXPECT_EQ(message({thin, {.name = "odd", .count = 1, .k = 0}}),
            "odd: k = 0: expected a number in [1e-12, 1e12]");
  EXPECT_EQ(message({thin, {.name = "rod", .count = 1, .diameter = 0.1}}),
            "rod: diameter = 0.1: expected 0: thin needles");
  EXPECT_EQ(message({thin, {.name = "few", .count = 1}}, 600),
            "needles = 600: expected more, as 60 of them are of species few, and 64 must be");
  EXPECT_EQ(message({{.name = "none"}}), "count = 0: expected 1 or more");
}

}  // namespace
}  // namespace needlework::boltzmann
