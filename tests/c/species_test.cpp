// Mixtures in C: species, pairs of them, and arrays that say which needle is of which.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/c/c_simulation.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

using test::Arrays;
using test::CSimulation;

const std::string rules =
    "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n"
    "[[pairs]]\nbetween = [\"rod\", \"short\"]\nepsilon = 0.6\nbeta = 0.25\n";

std::string mixture(const std::string& short_count, const std::string& rod_count) {
  return "[[species]]\nname = \"short\"\nlength = 0.5\nmass = 0.25\nk = 3\n" + short_count +
         "[[species]]\nname = \"rod\"\nlength = 1.5\nmass = 2\n" + rod_count;
}

const std::string drawn = "needles.box = 5\n" + rules + mixture("count = 80\n", "count = 20\n");

needlework_species species_of(needlework_simulation* gas, std::size_t index) {
  needlework_species out{};
  EXPECT_EQ(needlework_get_species(gas, index, &out), NEEDLEWORK_OK) << needlework_message(gas);
  return out;
}

needlework_species_pair pair_of(needlework_simulation* gas, std::size_t a, std::size_t b) {
  needlework_species_pair out{};
  EXPECT_EQ(needlework_get_species_pair(gas, a, b, &out), NEEDLEWORK_OK) << needlework_message(gas);
  return out;
}

std::vector<std::uint8_t> species_of_needles(needlework_simulation* gas) {
  std::vector<std::uint8_t> out(needlework_count(gas), 77);
  EXPECT_EQ(needlework_get_species_of_needles(gas, out.data()), NEEDLEWORK_OK);
  return out;
}

TEST(CSpecies, HaveNamesPropertiesAndPairs) {
  const CSimulation gas(drawn);
  ASSERT_NE(gas, nullptr) << gas.error.message;
  EXPECT_STREQ(needlework_species_name(gas, 0), "short");
  EXPECT_STREQ(needlework_species_name(gas, 1), "rod");
  EXPECT_EQ(needlework_species_name(gas, 2), nullptr);
  const needlework_species first = species_of(gas, 0), second = species_of(gas, 1);
  EXPECT_EQ(first.count, 80u);
  EXPECT_EQ(first.length, 0.5);
  EXPECT_EQ(first.mass, 0.25);
  EXPECT_EQ(first.k, 3);
  EXPECT_EQ(second.count, 20u);
  EXPECT_EQ(second.length, 1.5);
  EXPECT_EQ(second.k, 6);
  const needlework_species_pair cross = pair_of(gas, 1, 0);
  EXPECT_EQ(cross.epsilon, 0.6);
  EXPECT_EQ(cross.beta, 0.25);
  EXPECT_EQ(pair_of(gas, 1, 1).epsilon, 0.9);
  EXPECT_EQ(pair_of(gas, 1, 1).beta, -1);
}

TEST(CSpecies, MeetUnlessTheSceneSaysNot) {
  const CSimulation gas(drawn + "[[pairs]]\nbetween = ['rod', 'rod']\nmeet = false\n");
  ASSERT_NE(gas, nullptr) << gas.error.message;
  for (const std::size_t a : {0, 1}) {
    for (const std::size_t b : {0, 1}) {
      int meet = 7;
      EXPECT_EQ(needlework_species_meet(gas, a, b, &meet), NEEDLEWORK_OK);
      EXPECT_EQ(meet, a == 1 && b == 1 ? 0 : 1);
    }
  }
  int meet = 7;
  EXPECT_EQ(needlework_species_meet(gas, 0, 2, &meet), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_species_meet(gas, 0, 1, nullptr), NEEDLEWORK_USAGE);
}

TEST(CSpecies, ShareEnergyAndCollisions) {
  const CSimulation gas(drawn);
  gas.run_to(300);
  double t_tr = 0;
  for (const std::size_t index : {0, 1}) {
    const needlework_species each = species_of(gas, index);
    t_tr += static_cast<double>(each.count) * each.t_tr / 100;
  }
  EXPECT_NEAR(t_tr, gas.totals().t_tr, 1e-14);
  const std::uint64_t cross = pair_of(gas, 0, 1).collisions;
  EXPECT_EQ(cross, pair_of(gas, 1, 0).collisions);
  EXPECT_GT(cross, 50u);
  EXPECT_EQ(pair_of(gas, 0, 0).collisions + cross + pair_of(gas, 1, 1).collisions, 300u);

  const Arrays arrays(gas);
  const std::vector<std::uint8_t> indices = species_of_needles(gas);
  double v2 = 0;
  for (std::size_t n = 0; n < 100; ++n) {
    ASSERT_EQ(indices[n], n < 80 ? 0 : 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double v = arrays.velocity[3 * n + axis];
      if (indices[n] == 1) v2 += v * v;
    }
  }
  EXPECT_NEAR(species_of(gas, 1).t_tr, 2 * v2 / (3 * 20), 1e-14);
}

TEST(CSpecies, StartFromArraysInAnyOrder) {
  const CSimulation gas(drawn);
  const Arrays rows(gas);
  // The same needles from the last to the first, with ids that keep their order.
  Arrays reversed(100);
  std::vector<std::uint8_t> species(100);
  for (std::size_t n = 0; n < 100; ++n) {
    const std::size_t from = 99 - n;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      reversed.position[3 * n + axis] = rows.position[3 * from + axis];
      reversed.velocity[3 * n + axis] = rows.velocity[3 * from + axis];
      reversed.orientation[3 * n + axis] = rows.orientation[3 * from + axis];
      reversed.angular_velocity[3 * n + axis] = rows.angular_velocity[3 * from + axis];
    }
    reversed.id[n] = static_cast<std::uint32_t>(from);
    species[n] = from < 80 ? 0 : 1;
  }
  const needlework_initial initial = reversed.initial(5);
  for (const char* counts : {"", "count = 80\n"}) {
    const std::string scene =
        rules + mixture(counts, std::string(counts).empty() ? "" : "count = 20\n");
    needlework_error error;
    needlework_simulation* again =
        needlework_create_with_species(scene.c_str(), &initial, nullptr, species.data(), 0, &error);
    ASSERT_NE(again, nullptr) << error.message;
    EXPECT_EQ(species_of_needles(again), species_of_needles(gas));
    test::expect_same_start(Arrays(again), rows);
    EXPECT_NEAR(species_of(again, 1).t_tr, species_of(gas, 1).t_tr, 1e-14);
    needlework_destroy(again);
  }
}

TEST(CSpecies, RefusesSpeciesThatDoNotFit) {
  const CSimulation gas(drawn);
  const Arrays rows(gas);
  const needlework_initial initial = rows.initial(5);
  const auto message = [&](const std::string& scene, const std::vector<std::uint8_t>& species) {
    needlework_error error;
    EXPECT_EQ(
        needlework_create_with_species(scene.c_str(), &initial, nullptr, species.data(), 0, &error),
        nullptr);
    EXPECT_EQ(error.code, NEEDLEWORK_INPUT);
    return std::string(error.message);
  };
  std::vector<std::uint8_t> species = species_of_needles(gas);
  species[3] = 1;
  const std::string counted = rules + mixture("count = 80\n", "count = 20\n");
  EXPECT_TRUE(test::contains(message(counted, species), "species"));
  species[3] = 2;
  EXPECT_TRUE(test::contains(message(counted, species), "expected an index below 2"));
}

TEST(CSpecies, OfASceneWithoutAnyIsOne) {
  const CSimulation gas(test::cooling);
  gas.run_to(20);
  EXPECT_STREQ(needlework_species_name(gas, 0), "");
  EXPECT_EQ(needlework_species_name(gas, 1), nullptr);
  EXPECT_EQ(species_of(gas, 0).count, 60u);
  EXPECT_EQ(species_of(gas, 0).t_tr, gas.totals().t_tr);
  EXPECT_EQ(pair_of(gas, 0, 0).collisions, 20u);
  EXPECT_EQ(species_of_needles(gas), std::vector<std::uint8_t>(60, 0));
  needlework_species species{};
  EXPECT_EQ(needlework_get_species(gas, 1, &species), NEEDLEWORK_USAGE);
  EXPECT_EQ(gas.message(), "index = 1: expected 0, the only species");
  needlework_species_pair pair{};
  EXPECT_EQ(needlework_get_species_pair(gas, 0, 1, &pair), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_get_species_of_needles(gas, nullptr), NEEDLEWORK_USAGE);
}

}  // namespace
}  // namespace needlework
