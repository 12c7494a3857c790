// Rates and cooling of mixtures.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "needlework/error.h"
#include "needlework/theory.h"

namespace needlework {
namespace {

using theory::Temperatures;

Composition two_species(const Restitution& rule) {
  return Composition({{.name = "a", .count = 1000, .length = 1, .mass = 1, .k = 6},
                      {.name = "b", .count = 500, .length = 0.6, .mass = 2.5, .k = 3}},
                     rule);
}

// Numbers found by sampling contacts at random, within 1e-4.
TEST(MixtureRates, AgreeWithSampledContacts) {
  Composition composition = two_species({0.7, -1});
  // Only a-b: pairs of one species elastic leave energies as they are at one temperature only, so
  // the gains from those are taken off by a gas without the other.
  const std::array<Temperatures, 2> now = {Temperatures{1, 0.4}, Temperatures{0.5, 1.7}};
  const double volume = 10;
  const auto both = theory::mixture_rates(composition, volume, now);
  const double n_a = 100, n_b = 50;  // per volume
  EXPECT_NEAR(both.collisions[composition.pair_index(0, 1)] / volume, n_a * n_b * 0.51992,
              n_a * n_b * 1e-4);
  const auto alone = [&](std::size_t which) {
    Composition one({composition[which]}, composition.restitution(which, which));
    const std::array<Temperatures, 1> its = {now[which]};
    return theory::mixture_rates(one, volume, its).temperatures[0];
  };
  const Temperatures a = alone(0), b = alone(1);
  EXPECT_NEAR(1.5 * (both.temperatures[0].t_tr - a.t_tr), n_b * -0.23062, n_b * 2e-4);
  EXPECT_NEAR(both.temperatures[0].t_rot - a.t_rot, n_b * 0.11179, n_b * 2e-4);
  EXPECT_NEAR(1.5 * (both.temperatures[1].t_tr - b.t_tr), n_a * 0.05524, n_a * 2e-4);
  EXPECT_NEAR(both.temperatures[1].t_rot - b.t_rot, n_a * -0.14204, n_a * 2e-4);
}

TEST(MixtureRates, OfSpeciesThatPassThroughEachOtherAreZero) {
  Composition composition({{.name = "a", .count = 100}, {.name = "b", .count = 50, .length = 2}},
                          {0.8, 0.3});
  const std::array<Temperatures, 2> now = {Temperatures{1, 0.5}, Temperatures{2, 1}};
  const auto all = theory::mixture_rates(composition, 1000, now);
  composition.set_meets(0, 1, false);
  EXPECT_FALSE(composition.restitution(1, 0).is_rough());
  const auto some = theory::mixture_rates(composition, 1000, now);
  EXPECT_EQ(some.collisions, (std::vector{all.collisions[0], 0.0, all.collisions[2]}));
  composition.set_meets(0, 0, false);
  const auto last = theory::mixture_rates(composition, 1000, now);
  EXPECT_EQ(last.temperatures[0].t_tr, 0);
  EXPECT_EQ(last.temperatures[1].t_tr, some.temperatures[1].t_tr);
}

// One species, told as two, is what it is as one, smooth or rough.
TEST(MixtureRates, OfOneSpeciesTwiceAreThoseOfOne) {
  for (const Restitution rule : {Restitution{0.8, -1}, Restitution{0.6, 0.3}, Restitution{1, 1}}) {
    for (const Temperatures t : {Temperatures{1, 1}, Temperatures{1, 0}, Temperatures{0.2, 3}}) {
      // Enough needles for N and N - 1 to be one number.
      const std::uint64_t many = std::uint64_t{1} << 40;
      Composition composition(
          {{.name = "a", .count = many, .k = 3}, {.name = "b", .count = 3 * many, .k = 3}}, rule);
      const double density = 0.7, volume = 4 * static_cast<double>(many) / density;
      const std::array<Temperatures, 2> now = {t, t};
      const auto rates = theory::mixture_rates(composition, volume, now);
      double collisions = 0;
      for (const double each : rates.collisions) collisions += each;
      EXPECT_NEAR(2 * collisions / (4 * static_cast<double>(many)),
                  theory::collision_rate(density, t, 3), 1e-9);
      const double gamma = 2.0 / 3 * std::sqrt(std::numbers::pi) * density;
      const Temperatures expected =
          theory::cooling_rates({.k = 3, .epsilon = rule.epsilon, .beta = rule.beta}, t);
      for (const Temperatures& found : rates.temperatures) {
        EXPECT_NEAR(found.t_tr, gamma * expected.t_tr, 1e-8);
        EXPECT_NEAR(found.t_rot, gamma * expected.t_rot, 1e-8);
      }
    }
  }
}

// Elastic and perfectly rough collisions keep the energy, and at one temperature every rate is 0.
TEST(MixtureRates, KeepEnergyAndEquilibrium) {
  for (const double beta : {-1.0, 1.0}) {
    const Composition composition = two_species({1, beta});
    const std::array<Temperatures, 2> now = {Temperatures{1, 0.4}, Temperatures{0.5, 1.7}};
    const auto rates = theory::mixture_rates(composition, 10, now);
    double change = 0, size = 0;
    for (std::size_t n = 0; n < 2; ++n) {
      const double count = static_cast<double>(composition[n].count);
      change += count * rates.temperatures[n].energy();
      size += count * std::abs(rates.temperatures[n].t_tr);
    }
    EXPECT_NEAR(change / size, 0, 1e-9);
    const std::array<Temperatures, 2> equal = {Temperatures{2, 2}, Temperatures{2, 2}};
    for (const Temperatures& each : theory::mixture_rates(composition, 10, equal).temperatures) {
      EXPECT_NEAR(each.t_tr / size, 0, 1e-9);
      EXPECT_NEAR(each.t_rot / size, 0, 1e-9);
    }
  }
}

TEST(MixtureCooling, AndItsCollisionsAreThoseOfOneSpeciesWhereThereIsOne) {
  const std::uint64_t many = std::uint64_t{1} << 40;
  const Composition composition({{.name = "a", .count = many}, {.name = "b", .count = many}},
                                {0.8, -1});
  const double density = 0.7, volume = 2 * static_cast<double>(many) / density;
  const double gamma = 2.0 / 3 * std::sqrt(std::numbers::pi) * density;
  const std::array<Temperatures, 2> initial = {Temperatures{1, 0}, Temperatures{1, 0}};
  const std::array taus = {1e4, 0.0, 1.0, 100.0};
  std::array<double, 4> times{};
  for (std::size_t n = 0; n < taus.size(); ++n) times[n] = taus[n] / gamma;
  const auto found = theory::mixture_cooling(composition, volume, initial, times);
  const auto expected = theory::cooling_curve({.k = 6, .epsilon = 0.8}, initial[0], taus);
  for (std::size_t n = 0; n < taus.size(); ++n) {
    for (const Temperatures& each : found[n]) {
      EXPECT_NEAR(each.t_tr, expected[n].t_tr, 1e-7 * expected[n].t_tr) << taus[n];
      EXPECT_NEAR(each.t_rot, expected[n].t_rot, 1e-7 * expected[n].t_rot + 1e-12) << taus[n];
    }
  }
  theory::MixtureCurve curve(composition, volume, initial);
  for (const double tau : {0.1, 10.0, 1e6}) {
    curve.at(tau / gamma);
    const double collisions =
        theory::collisions_per_needle({.k = 6, .epsilon = 0.8}, initial[0], std::span(&tau, 1))[0];
    EXPECT_NEAR(curve.collisions_per_needle() / collisions, 1, 1e-6) << tau;
  }
}

// The change over a short time is the rate.
TEST(MixtureCooling, BeginsWithItsRates) {
  const Composition composition = two_species({0.7, 0.2});
  const std::array<Temperatures, 2> initial = {Temperatures{1, 0.4}, Temperatures{0.5, 1.7}};
  const auto rates = theory::mixture_rates(composition, 10, initial);
  const std::array times = {1e-7};
  const auto later = theory::mixture_cooling(composition, 10, initial, times)[0];
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_NEAR((later[n].t_tr - initial[n].t_tr) / times[0] / rates.temperatures[n].t_tr, 1, 1e-4);
    EXPECT_NEAR((later[n].t_rot - initial[n].t_rot) / times[0] / rates.temperatures[n].t_rot, 1,
                1e-4);
  }
}

// Once the ratios of the temperatures have relaxed, all fall as t^-2, however long.
TEST(MixtureCooling, FollowsHaffsLawInTheEnd) {
  const Composition composition = two_species({0.7, 0.2});
  const std::array<Temperatures, 2> initial = {Temperatures{1, 0.4}, Temperatures{0.5, 1.7}};
  const std::array times = {1e6, 1e12, 1e18};
  const auto found = theory::mixture_cooling(composition, 10, initial, times);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_NEAR(found[1][n].t_tr / found[0][n].t_tr, 1e-12, 1e-18);
    EXPECT_NEAR(found[2][n].t_rot / found[1][n].t_rot, 1e-12, 1e-18);
    EXPECT_NEAR(found[2][n].t_tr / found[2][n].t_rot / (found[0][n].t_tr / found[0][n].t_rot), 1,
                1e-7);
  }
}

TEST(MixtureCooling, EndsInEquipartitionWhereNothingIsLost) {
  const Composition composition = two_species({1, -1});
  const std::array<Temperatures, 2> initial = {Temperatures{1, 0.4}, Temperatures{0.5, 1.7}};
  const std::array times = {1e9};
  const auto found = theory::mixture_cooling(composition, 10, initial, times)[0];
  const double energy = theory::mean_of_species(composition, initial).energy();
  for (const Temperatures& each : found) {
    EXPECT_NEAR(each.t_tr, energy / 2.5, 1e-7);
    EXPECT_NEAR(each.t_rot, energy / 2.5, 1e-7);
  }
}

// Ratios that take more collisions than can be followed.
TEST(MixtureCooling, IsGivenUpWhereMassesDifferByManyOrders) {
  const Composition composition({{.name = "a", .count = 1000, .length = 1, .mass = 1, .k = 6},
                                 {.name = "b", .count = 10, .length = 1, .mass = 1e9, .k = 6}},
                                {1, -1});
  const std::array<Temperatures, 2> initial = {Temperatures{1, 1}, Temperatures{2, 2}};
  const std::array times = {1e-3, 1e9};
  const auto found = theory::mixture_cooling(composition, 1000, initial, times);
  EXPECT_NEAR(found[0][1].t_tr, 2, 1e-6);
  EXPECT_TRUE(std::isnan(found[1][0].t_tr));
}

TEST(MixtureCurve, GoesOnFromItsPlaceToTheLastBit) {
  const Composition composition = two_species({0.7, 0.2});
  const std::array<Temperatures, 2> initial = {Temperatures{1, 0.4}, Temperatures{0.5, 1.7}};
  theory::MixtureCurve first(composition, 10, initial), second(composition, 10, initial);
  first.at(0.01);
  first.at(0.5);
  second.go_to(first.place());
  for (const double time : {0.6, 7.0, 1e5}) {
    const auto a = first.at(time), b = second.at(time);
    for (std::size_t n = 0; n < 2; ++n) {
      EXPECT_EQ(a[n].t_tr, b[n].t_tr);
      EXPECT_EQ(a[n].t_rot, b[n].t_rot);
    }
    EXPECT_EQ(first.collisions_per_needle(), second.collisions_per_needle());
  }
  std::vector<double> wrong = first.place();
  wrong.pop_back();
  EXPECT_THROW(second.go_to(wrong), InputError);
  wrong = first.place();
  wrong[0] = std::nan("");
  EXPECT_THROW(second.go_to(wrong), InputError);
}

TEST(MixtureEquilibrium, OfOneSpeciesTwiceHasTheRateOfOne) {
  const Composition composition(
      {{.name = "a", .count = 30, .k = 3}, {.name = "b", .count = 50, .k = 3}}, {1, -1});
  const auto rates = theory::mixture_equilibrium_rates(composition, 100, 200);
  const double all = rates[0] + rates[1] + rates[2];
  EXPECT_NEAR(2 * all / 80 / theory::equilibrium_rate(80, 100, 200, 3), 1, 1e-9);
}

}  // namespace
}  // namespace needlework
