// What is known before a run of gases whose bodies have numbers of their own, or are fixed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "needlework/h5md.h"
#include "needlework/initial_state.h"
#include "needlework/parse.h"
#include "needlework/theory.h"
#include "src/runs/exact_rates.h"
#include "src/runs/explanation.h"
#include "src/runs/size_text.h"
#include "src/runs/state_file.h"
#include "tests/support/contains.h"
#include "tests/support/pair_rates.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

Scene parsed(const std::string& text) { return parse_scene(text, "scene.toml"); }

Scene lognormal_needles(const std::string& more = "") {
  return parsed(
      "needles = { box = 8, seed = 4 }\nuntil.collisions_per_needle = 10\n" + more +
      "[[species]]\nname = \"a\"\ncount = 200\nlength.distribution = \"lognormal\"\n"
      "length.mean = 1\nlength.width = 0.4\nmass.density = 2\n"
      "[[species]]\nname = \"b\"\ncount = 100\nlength = 0.7\nmass.distribution = \"gamma\"\n"
      "mass.mean = 1\nmass.width = 0.5\nk = 3\n");
}

// 100 of T = 1 among 300 fixed ones of length 0.8.
Scene among_fixed(bool meet, const std::string& more = "") {
  return parsed(std::string("needles.box = 8\nuntil.collisions_per_needle = 10\n") + more +
                "[[species]]\nname = \"moving\"\ncount = 100\nmass = 2\n"
                "[[species]]\nname = \"still\"\ncount = 300\nlength = 0.8\nfixed = true\n" +
                (meet ? "" : "[[pairs]]\nbetween = [\"moving\", \"moving\"]\nmeet = false\n"));
}

double rate_of_two(const BodyNumbers& a, const BodyNumbers& b, double t) {
  const auto body = [&](const BodyNumbers& of) {
    return theory::Body{of.length, of.diameter, of.mass, of.inertia, {t, t}};
  };
  return test::rate_of_pair(body(a), body(b));
}

double total(const std::vector<double>& all) {
  return std::accumulate(all.begin(), all.end(), 0.0);
}

// Law: rates of all pairs at T = 2 E / (5 N - 3), times the factor of a fixed energy.
TEST(OwnBodies, HaveTheEquilibriumRatesOfTheSumOverAllPairs) {
  const Scene scene = lognormal_needles();
  const Members members = drawn_members(scene);
  ASSERT_EQ(members.size(), 300u);
  const auto [t, speed] = theory::equilibrium_of(300, 300 * 2.5, 3);
  std::vector<double> expected(3);
  for (std::size_t i = 0; i < 300; ++i) {
    for (std::size_t j = i + 1; j < 300; ++j) {
      expected[members.composition.pair_index(members.species[i], members.species[j])] +=
          speed / 512 * rate_of_two(members.body(i), members.body(j), t);
    }
  }
  const std::vector<double> found = equilibrium_rates_by_pair(scene, 2.5);
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(found[n], expected[n], 1e-7 * expected[n]) << n;
  EXPECT_NEAR(equilibrium_rate(scene, 2.5), 2 * total(expected) / 300, 1e-7 * total(expected));
  // Rates by the means of the species are others.
  const double by_means =
      total(theory::mixture_equilibrium_rates(scene.composition(), 512, 300 * 2.5));
  EXPECT_GT(std::abs(by_means / total(expected) - 1), 0.01);
}

TEST(OwnBodies, HaveTheRatesOfAHeatBath) {
  const Scene scene = lognormal_needles("driving.andersen = { rate = 1, temperature = 1 }\n");
  const Members members = drawn_members(scene);
  double expected = 0;
  for (std::size_t i = 0; i < 300; ++i)
    for (std::size_t j = i + 1; j < 300; ++j)
      expected += rate_of_two(members.body(i), members.body(j), 1) / 512;
  EXPECT_NEAR(total(equilibrium_rates_by_pair(scene, 2.5)), expected, 1e-7 * expected);
}

// Between walls positions of long ones and short ones differ.
TEST(OwnBodies, HaveNoExactRateBetweenWalls) {
  EXPECT_TRUE(std::isnan(
      equilibrium_rate(lognormal_needles("[[walls]]\naxis = \"z\"\nside = \"both\"\n"), 2.5)));
}

// Mean free times, by which t_c and windows go, are those of the means; the temperatures of a
// species scatter around those asked for.
TEST(OwnBodies, HaveTheMeanFreeTimeOfTheSimulation) {
  for (const Scene& scene : {lognormal_needles(), among_fixed(true), among_fixed(false)}) {
    const Simulation simulation(scene);
    EXPECT_NEAR(
        initial_collision_rate({.scene = scene, .initial = {}}) * simulation.mean_free_time(), 1,
        2e-3);
  }
  const Scene alone = parsed(
      "needles.box = 14\nuntil.time = 1\n[[species]]\nname = \"a\"\ncount = 200\n"
      "length.distribution = \"lognormal\"\nlength.mean = 2\nlength.width = 0.4\n"
      "mass.density = 2\n");
  EXPECT_NEAR(
      initial_collision_rate({.scene = alone, .initial = {}}) * Simulation(alone).mean_free_time(),
      1, 1e-9);
}

// One needle among fixed ones, and two kinds, has the rate nu = n L L' sqrt(pi / 8) sqrt(T / m)
// <sqrt(1 + 2 k x^2)> = 0.864895165 n L L' sqrt(T / m) for k = 6, whatever the density.
TEST(FixedBodies, AreHitAtTheStartAtTheRateOfTheMovingOnes) {
  const Scene scene = among_fixed(false);
  const std::vector<double> rates = initial_rates_by_pair({.scene = scene, .initial = {}});
  const double one = 0.864895165 * 300 / 512 * 0.8 / std::sqrt(2);
  EXPECT_NEAR(rates[1], 100 * one, 1e-6 * 100 * one);
  EXPECT_EQ(rates[0], 0);
  EXPECT_EQ(rates[2], 0);
}

// Law: fixed bodies that lie anywhere are met as often as at low density, however densely they lie;
// those that keep apart leave a needle less of the box by their share of it.
TEST(FixedBodies, AreMetAsOftenAsTheyLeaveRoom) {
  for (const bool overlap : {true, false}) {
    const LoadedScene loaded{
        parsed(
            "needles.box = 8\nuntil.time = 1\n[[species]]\nname = \"moving\"\ncount = 10\n"
            "[[species]]\nname = \"still\"\ncount = 200\nlength = 0\ndiameter = 1\nfixed = true\n"
            "overlap = " +
            std::string(overlap ? "true" : "false")),
        {}};
    const double free = 1 - 200 * std::numbers::pi / 6 / 512;
    const double factor = initial_contacts_by_pair(loaded)[1] / initial_rates_by_pair(loaded)[1];
    EXPECT_NEAR(factor, overlap ? 1 : 1 / free, 1e-12);
  }
}

// Those that meet fixed ones alone keep their energies E, and have 1.0509358 of the rate at T = 2 E
// / 5.
TEST(FixedBodies, AreHitInEquilibriumAtTheRateOfTheEnergiesDrawn) {
  const Scene scene = among_fixed(false);
  const State start = draw_initial_state(scene);
  const auto square = [](const std::array<double, 3>& a) {
    return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
  };
  double expected = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double energy =
        square(start.velocity[i]) + square(start.angular_velocity[i]) * (2 / 12.0) / 2;
    expected += 1.0509358 * 0.864895165 * 300 / 512 * 0.8 * std::sqrt(0.4 * energy / 2);
  }
  EXPECT_NEAR(equilibrium_rates_by_pair(scene, 2.5)[1], expected, 1e-6 * expected);
  EXPECT_NEAR(equilibrium_rate(scene, 2.5), 2 * expected / 400, 1e-6 * expected);
  // On average over draws it is the rate at the start.
  const double start_rate = initial_rates_by_pair({.scene = scene, .initial = {}})[1];
  EXPECT_NEAR(expected, start_rate, 0.05 * start_rate);
}

// Those that meet each other share all of it; their momentum is not conserved.
TEST(FixedBodies, AreHitInEquilibriumAtTheRateOfTheSharedEnergy) {
  const Scene scene = among_fixed(true);
  const auto [t, speed] = theory::equilibrium_of(100, 250, 0);
  EXPECT_NEAR(t, 1, 1e-12);
  const std::vector<double> rates = equilibrium_rates_by_pair(scene, 2.5);
  const double with_fixed = speed * 0.864895165 * 100 * 300 / 512 * 0.8 / std::sqrt(2);
  EXPECT_NEAR(rates[1], with_fixed, 1e-6 * with_fixed);
  const BodyNumbers moving{1, 0, 2, 2.0 / 12};
  const double each_other = speed * 100 * 99 / 2 * rate_of_two(moving, moving, 1) / 512;
  EXPECT_NEAR(rates[0], each_other, 1e-6 * each_other);
  EXPECT_EQ(rates[2], 0);
}

// Some share their energy and others do not.
TEST(FixedBodies, HaveNoExactRateWhereOnlySomeMeet) {
  const std::string species =
      "needles.box = 8\nuntil.time = 1\n[[species]]\nname = \"a\"\ncount = 10\n"
      "[[species]]\nname = \"b\"\ncount = 10\n"
      "[[species]]\nname = \"still\"\ncount = 30\nfixed = true\n";
  EXPECT_FALSE(equilibrium_rates_by_pair(parsed(species), 2.5).empty());
  EXPECT_TRUE(equilibrium_rates_by_pair(
                  parsed(species + "[[pairs]]\nbetween = [\"a\", \"b\"]\nmeet = false\n"), 2.5)
                  .empty());
  // Fixed ones that nobody meets keep no momentum, nor does a drawn state have none.
  EXPECT_TRUE(equilibrium_rates_by_pair(
                  parsed(species + "[[pairs]]\nbetween = [\"a\", \"still\"]\nmeet = false\n"
                                   "[[pairs]]\nbetween = [\"b\", \"still\"]\nmeet = false\n"),
                  2.5)
                  .empty());
}

TEST(FixedBodies, AreNotAmongThoseOfWhichTemperaturesAre) {
  const Scene scene = among_fixed(true);
  const Explanation explained({.scene = scene, .initial = {}});
  EXPECT_NEAR(explained.initial.t_tr, 1, 1e-12);
  EXPECT_NEAR(explained.initial.t_rot, 1, 1e-12);
  EXPECT_NEAR(explained.initial.energy(), 2.5, 1e-12);
  ASSERT_TRUE(explained.expected);
  // 2 collisions / N of all 400.
  EXPECT_EQ(explained.expected->collisions_per_needle, 10);
  const double all = total(initial_rates_by_pair({.scene = scene, .initial = {}}));
  EXPECT_NEAR(explained.expected->time, 10 * 400 / (2 * all), 1e-9);
  EXPECT_EQ(explained.expected->energy_ratio, 1);
}

TEST(OwnBodies, HaveNoTheoryOfCooling) {
  for (const Scene& scene :
       {lognormal_needles("collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n"),
        among_fixed(true, "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n")}) {
    const LoadedScene loaded{.scene = scene, .initial = {}};
    EXPECT_FALSE(Explanation(loaded).expected);
    EXPECT_NE(beyond_cooling_theory(scene.composition()), nullptr);
  }
}

// Of a state that is read each body counts with its own mass and moment of inertia.
TEST(OwnBodies, HaveTheTemperaturesOfTheStateThatIsRead) {
  const test::TemporaryFolder folder;
  for (const Scene& scene : {lognormal_needles(), among_fixed(true)}) {
    Simulation simulation(scene);
    simulation.advance(test::until_collisions(3));
    const std::string file = (folder.path() / "state.h5").string();
    write_state(simulation, scene, {}, file, true);
    const LoadedScene loaded =
        complete_scene(parsed("initial.file = \"" + file + "\"\nuntil.time = 1\n"));
    const Totals totals = simulation.totals();
    const theory::Temperatures all = initial_temperatures(loaded);
    EXPECT_NEAR(all.t_tr, totals.t_tr, 1e-12);
    EXPECT_NEAR(all.t_rot, totals.t_rot, 1e-12);
    const auto by_species = temperatures_by_species(loaded);
    for (std::size_t n = 0; n < 2; ++n) {
      EXPECT_NEAR(by_species[n].t_tr, simulation.species_totals()[n].t_tr, 1e-12);
      EXPECT_NEAR(by_species[n].t_rot, simulation.species_totals()[n].t_rot, 1e-12);
    }
    // Bodies that are read have the rates of those that were drawn, at their temperatures.
    if (!scene.composition().has_own_sizes()) continue;
    const std::vector<double> rates = initial_rates_by_pair(loaded);
    const std::vector<double> drawn = initial_rates_by_pair({.scene = scene, .initial = {}});
    for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(rates[n], drawn[n], 0.15 * drawn[n]);
  }
}

// Spheres that differ are in contact as often as their contact values say.
TEST(OwnBodies, HaveTheContactsOfSpheresThatDiffer) {
  const Scene scene = parsed(
      "needles.box = 6\nuntil.collisions_per_needle = 20\n[[species]]\nname = \"balls\"\n"
      "count = 300\nlength = 0\ndiameter.distribution = \"lognormal\"\ndiameter.mean = 0.6\n"
      "diameter.width = 0.3\nmass.density = 1\n");
  const LoadedScene loaded{.scene = scene, .initial = {}};
  const double dilute = total(initial_rates_by_pair(loaded));
  const double fluid = total(initial_contacts_by_pair(loaded));
  const Composition composition = scene.composition();
  const double contact = theory::contact_values(composition, 216)[0];
  // The mean by (D + D')^2 alone leaves out that small spheres are fast.
  EXPECT_NEAR(fluid / dilute, contact, 0.03 * contact);
  Simulation simulation(scene);
  simulation.advance(scene.until);
  EXPECT_NEAR(Explanation(loaded).expected->time, simulation.time(), 0.05 * simulation.time());
}

TEST(SizeText, SaysHowBodiesAreDrawnAndWhatCameOfIt) {
  const Composition composition = lognormal_needles().composition();
  const std::vector<std::string> a = size_lines(composition[0]), b = size_lines(composition[1]);
  ASSERT_EQ(a.size(), 2u);
  EXPECT_TRUE(test::contains(a[0], "length lognormal of mean 1, width 0.4: drawn mean "));
  EXPECT_TRUE(test::contains(a[1], "mass of density 2: drawn mean "));
  ASSERT_EQ(b.size(), 1u);
  EXPECT_TRUE(test::contains(b[0], "mass gamma of mean 1, width 0.5: drawn mean "));
  // k of the mean moment of inertia is another.
  EXPECT_EQ(shape_text(composition[0]), "k = 6, uniform rods");
  EXPECT_EQ(shape_text(composition[1]), "k = 3");
  EXPECT_LT(composition[0].k, 5);
  EXPECT_TRUE(size_lines(among_fixed(true).composition()[1]).empty());
  EXPECT_EQ(shape_text(among_fixed(true).composition()[1]), "thin needles");
}

TEST(Sizes, AreMeansAndWidthsOfTheBodiesDrawn) {
  const Scene scene = lognormal_needles();
  const Members members = drawn_members(scene);
  const Sizes& sizes = *members.composition[0].sizes;
  double mean = 0, square = 0, least = 9, greatest = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    const double length = members.body(i).length;
    mean += length / 200;
    square += length * length / 200;
    least = std::min(least, length);
    greatest = std::max(greatest, length);
  }
  EXPECT_NEAR(sizes.length.mean, mean, 1e-14);
  EXPECT_NEAR(sizes.length.width, std::sqrt(square / (mean * mean) - 1), 1e-12);
  EXPECT_EQ(sizes.length.least, least);
  EXPECT_EQ(sizes.length.greatest, greatest);
  EXPECT_EQ(sizes.k.mean, 6);
  EXPECT_TRUE(sizes.k.is_one() && sizes.diameter.is_one() && !sizes.mass.is_one());
}

}  // namespace
}  // namespace needlework::runs
