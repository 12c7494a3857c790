// The direct simulation of the Boltzmann equation: exact at its start, where velocities are
// Gaussian; and encounters of pairs as an independent count has found them.
#include "needlework/boltzmann.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/boltzmann/sums.h"
#include "tests/support/message_of.h"

namespace needlework::boltzmann {
namespace {

using std::numbers::pi;

Result result_of(const Settings& settings, const std::vector<double>& taus, int threads = 2) {
  return simulate(settings, taus, threads);
}

// Changes over a time so short that the rates of the theory hold, and half of it: the part that is
// of second order drops out.
TEST(Boltzmann, BeginsAsKineticTheorySays) {
  for (const auto& [gas, t_rot] :
       {std::pair{theory::Gas{6, 1, -1}, 0.4}, {{2, 0.8, -1}, 1.7}, {{6, 0.9, 0.3}, 0.0}}) {
    const theory::Temperatures initial{1, t_rot};
    const double tau = 0.05;
    const Result result =
        result_of({.composition = one_species(gas, initial), .needles = 1'000'000}, {tau / 2, tau});
    const theory::Temperatures rates = theory::cooling_rates(gas, initial);
    const Sample &half = result.samples[0], &whole = result.samples[1];
    const auto slope = [&](double at_0, const Measured& at_half, const Measured& at_whole) {
      return (4 * (at_half.value - at_0) - (at_whole.value - at_0)) / tau;
    };
    const auto error = [&](const Measured& at_half, const Measured& at_whole) {
      return (4 * at_half.error + at_whole.error) / tau;
    };
    EXPECT_NEAR(slope(1, half.t_tr, whole.t_tr), rates.t_tr, 3 * error(half.t_tr, whole.t_tr));
    EXPECT_NEAR(slope(t_rot, half.t_rot, whole.t_rot), rates.t_rot,
                3 * error(half.t_rot, whole.t_rot));
    EXPECT_LT(error(half.t_rot, whole.t_rot), 0.1 * std::abs(rates.t_rot));
    const double rate = theory::collision_rate(1, initial, gas.k) / (2.0 / 3 * std::sqrt(pi));
    EXPECT_NEAR(slope(0, half.collisions, whole.collisions), rate,
                3 * error(half.collisions, whole.collisions));
    EXPECT_LT(error(half.collisions, whole.collisions), 0.03 * rate);
  }
}

TEST(Boltzmann, ElasticCollisionsKeepTheEnergy) {
  for (const Pairs pairs : {Pairs::single, Pairs::encounters}) {
    const Result result = result_of(
        {.composition = one_species({6, 1, -1}, {1, 0.4}), .pairs = pairs, .needles = 1600},
        {0, 10});
    EXPECT_NEAR(result.samples[0].energy.value, 1.9, 1e-12);
    EXPECT_NEAR(result.samples[1].energy.value, 1.9, 1e-11);
    EXPECT_NEAR(result.samples[1].t_tr.value, 1.9 / 2.5, 0.05);
  }
}

double share_met_before(const Result& result) {
  const auto of = static_cast<double>(result.met_before + result.encounters);
  return static_cast<double>(result.met_before) / of;
}

// In elastic equilibrium a film may be run backwards: as many contacts are not the first of their
// encounter as are not the last.
TEST(Boltzmann, EncountersOfAnEquilibriumMayBeRunBackwards) {
  for (const double k : {2.0, 6.0}) {
    const Result result = result_of({.composition = one_species({k, 1, -1}, {1, 1}),
                                     .pairs = Pairs::encounters,
                                     .needles = 32000},
                                    {1});
    const auto of = static_cast<double>(result.encounters);
    const double collisions = result.samples[0].collisions.value * 16000;
    const double share = share_met_before(result);
    EXPECT_NEAR(share, 1 - of / collisions, 4 * std::sqrt(2 * share / of));
    EXPECT_GT(share, 0.05);
    EXPECT_GT(of, 1e4);
  }
}

TEST(Boltzmann, EncountersOfElasticNeedlesAreThoseOfAnotherCount) {
  for (const auto& [k, met_before, collisions] : {std::tuple{6.0, 0.12, 1.23}, {2.0, 0.06, 1.10}}) {
    const Result result = result_of({.composition = one_species({k, 1, -1}, {1, 0.5}),
                                     .pairs = Pairs::encounters,
                                     .needles = 200000},
                                    {0.1});
    const auto of = static_cast<double>(result.encounters);
    EXPECT_GT(of, 5e3);
    EXPECT_NEAR(share_met_before(result), met_before, 0.01);
    EXPECT_NEAR(result.samples[0].collisions.value * 100000 / of, collisions, 0.02);
    EXPECT_EQ(result.unfinished, 0u);
    EXPECT_EQ(result.tc_collisions, 0u);
  }
}

// Chains of 20 collisions and more, which tend to sliding contact.
TEST(Boltzmann, EncountersCollapseAsOftenAsInAnotherCount) {
  const double share = 0.047;
  const Result result = result_of({.composition = one_species({6, 0.5, -1}, {1, 1}),
                                   .pairs = Pairs::encounters,
                                   .contact_time = 1e-3,
                                   .needles = 64000},
                                  {0.1});
  std::uint64_t chains = 0;
  for (std::size_t n = 19; n < result.encounters_of.size(); ++n) chains += result.encounters_of[n];
  const auto of = static_cast<double>(result.encounters);
  EXPECT_GT(of, 2e3);
  EXPECT_NEAR(static_cast<double>(chains) / of, share, 4 * std::sqrt(share / of));
  EXPECT_GT(result.tc_collisions, 0u);
}

// By an independent count the temperatures approach each other at 0.88 of the rate of the theory,
// for k = 6 and 2, as velocities do not stay Gaussian; here fitted between 1/e and 1/e^3 of the
// theory.
TEST(Boltzmann, SingleCollisionsRelaxMoreSlowlyThanGaussianOnes_long) {
  for (const double k : {6.0, 2.0}) {
    const theory::Gas gas{k, 1, -1};
    const theory::Temperatures initial{1, 0.4};
    const auto difference = [](double t_tr, double t_rot) { return (t_tr - t_rot) / 0.6; };
    std::vector<double> taus;
    for (double tau = 0.1; taus.size() < 2; tau += 0.1) {
      const theory::Temperatures now = theory::cooling_curve(gas, initial, std::array{tau})[0];
      if (difference(now.t_tr, now.t_rot) < std::exp(taus.empty() ? -1 : -3)) taus.push_back(tau);
    }
    const Result result =
        result_of({.composition = one_species(gas, initial), .needles = 400'000}, taus);
    const auto curve = theory::cooling_curve(gas, initial, taus);
    const auto logarithm = [&](std::size_t n) {
      return std::log(difference(result.samples[n].t_tr.value, result.samples[n].t_rot.value));
    };
    const auto of_theory = [&](std::size_t n) {
      return std::log(difference(curve[n].t_tr, curve[n].t_rot));
    };
    const double ratio = (logarithm(1) - logarithm(0)) / (of_theory(1) - of_theory(0));
    EXPECT_NEAR(ratio, 0.88, 0.04) << "k " << k;
  }
}

// A needle without rotation keeps its director, and collides the less the more it flies along it.
// The numbers are those of an independent simulation (3 x 200000 needles in random pairs at equal
// steps of time, each rotating freely between them); with directors drawn anew the ratio is 1.704.
TEST(Boltzmann, NeedlesWithoutRotationKeepTheirDirectors) {
  const Result result =
      result_of({.composition = one_species({6, 0.8, -1}, {1, 0}), .needles = 200'000}, {3.001});
  const Sample& sample = result.samples[0];
  EXPECT_NEAR(sample.t_tr.value / sample.t_rot.value, 1.7645, 0.015);
  EXPECT_NEAR(sample.excess_mixed.value, -0.016, 0.006);
}

// While few needles rotate, a mean of the excesses of small pools would be far off.
TEST(Boltzmann, ExcessesOfFewNeedlesAreThoseOfMany) {
  const auto excess = [](std::uint64_t needles, std::uint64_t seed) {
    return result_of(
               {.composition = one_species({6, 0.8, -1}, {1, 0}), .needles = needles, .seed = seed},
               {0.1})
        .samples[0]
        .excess_mixed;
  };
  const Measured many = excess(800'000, 1);
  double sum = 0, squares = 0;
  constexpr int seeds = 100;
  for (int seed = 2; seed < 2 + seeds; ++seed) {
    const double value = excess(1600, seed).value;
    sum += value, squares += value * value;
  }
  const double mean = sum / seeds, error = std::sqrt((squares / seeds - mean * mean) / (seeds - 1));
  EXPECT_NEAR(mean, many.value, 3 * std::hypot(error, many.error));
  EXPECT_LT(std::hypot(error, many.error), 0.02);
}

// Of a ratio of sums, that of the sums over all pools; of a mean over equal pools, the usual error.
TEST(Boltzmann, NumbersOfPoolsAreThoseOfTheirSums) {
  std::vector<Sums> pools(3);
  for (std::size_t p = 0; p < pools.size(); ++p) {
    const auto of = static_cast<double>(p);
    pools[p] = {
        .needles = 2, .collisions = 2 * of, .tr = 6 + 6 * of, .rot = 1 + of, .tr_rot = 4 * of};
  }
  const Means sample = measured(pools);
  EXPECT_DOUBLE_EQ(sample.t_tr.value, 2);  // of 1, 2 and 3
  EXPECT_DOUBLE_EQ(sample.t_rot.value, 0.5);
  EXPECT_DOUBLE_EQ(sample.t_tr.error, std::sqrt(1.0 / 3));
  EXPECT_DOUBLE_EQ(sample.collisions.value, 1);  // of 0, 1 and 2
  EXPECT_DOUBLE_EQ(sample.excess_mixed.value, 6 * 12.0 / (36 * 6) - 1);
  // Without the first pool, the second and the third.
  const double without[] = {4 * 12.0 / (30 * 5), 4 * 8.0 / (24 * 4), 4 * 4.0 / (18 * 3)};
  const double mean = (without[0] + without[1] + without[2]) / 3;
  double squares = 0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  EXPECT_NEAR(sample.excess_mixed.error, std::sqrt(squares * 2 / 3), 1e-14);
}

TEST(Boltzmann, DependsOnItsSeedAndNotOnThreads) {
  Settings settings{.composition = one_species({6, 0.8, -1}),
                    .pairs = Pairs::encounters,
                    .needles = 640,
                    .seed = 7};
  const auto energy = [&](int threads) {
    return result_of(settings, {0.5, 1}, threads).samples[1].energy.value;
  };
  const double once = energy(1);
  EXPECT_EQ(energy(2), once);
  EXPECT_EQ(energy(5), once);
  settings.seed = 8;
  EXPECT_NE(energy(1), once);
}

TEST(Boltzmann, RefusesWhatItCannotFollow) {
  const auto message = [](Settings settings, std::vector<double> taus = {1}) {
    return test::message_of<std::invalid_argument>([&] { simulate(settings, taus); });
  };
  Settings settings;
  settings.composition = one_species({6, 0.9, -1});
  settings.pairs = Pairs::encounters;
  settings.contact_time = 0;
  EXPECT_EQ(message(settings),
            "contact_time = 0: expected a number in [1e-9, 1e100], as encounters of this gas may "
            "collapse");
  settings = {};
  settings.needles = 63;
  EXPECT_EQ(message(settings), "needles = 63: expected a number in [64, 1e9]");
  settings = {};
  settings.composition = one_species({}, {0, 1});
  EXPECT_EQ(message(settings), "t_tr = 0: expected a number in [1e-100, 1e100]");
  EXPECT_EQ(message({}, {2, 1}), "tau = 1: expected finite times >= 0 in ascending order");
  settings = {};
  settings.composition = one_species({std::nan(""), 1, -1});
  EXPECT_EQ(message(settings), "k = nan: expected a number in [1e-12, 1e12]");
}

}  // namespace
}  // namespace needlework::boltzmann
