// Numbers of each needle, given and got by C programs.
#include <cmath>
#include <limits>

#include "tests/c/c_simulation.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

using test::Arrays;
using test::CSimulation;

struct Bodies {
  explicit Bodies(needlework_simulation* gas)
      : length(needlework_count(gas)), diameter(length), mass(length), inertia(length) {
    EXPECT_EQ(
        needlework_get_bodies(gas, length.data(), diameter.data(), mass.data(), inertia.data()),
        NEEDLEWORK_OK);
    EXPECT_EQ(needlework_get_bodies(gas, nullptr, nullptr, nullptr, nullptr), NEEDLEWORK_OK);
  }
  needlework_bodies given() const {
    return {length.data(), diameter.data(), mass.data(), inertia.data()};
  }
  std::vector<double> length, diameter, mass, inertia;
};

const std::string drawn =
    "needles.box = 6\n[[species]]\nname = \"a\"\ncount = 60\nmass.density = 1\n"
    "length = { distribution = \"gamma\", mean = 1, width = 0.3 }\n"
    "[[species]]\nname = \"wall\"\ncount = 10\nlength = 2\nfixed = true\n";
const std::string silent =
    "until.time = 9\n[[species]]\nname = \"a\"\n"
    "[[species]]\nname = \"wall\"\nfixed = true\n";

needlework_simulation* from(const Arrays& arrays, const std::vector<std::uint8_t>& species,
                            const needlework_bodies& bodies, needlework_error& error) {
  const needlework_initial initial = arrays.initial(6);
  return needlework_create_with_bodies(silent.c_str(), &initial, arrays.image.data(),
                                       species.data(), &bodies, 0, &error);
}

TEST(CBodies, ComeBackAsTheyWereGiven) {
  const CSimulation gas(drawn);
  ASSERT_NE(gas, nullptr) << gas.error.message;
  gas.run_to(40);
  const Bodies bodies(gas);
  EXPECT_NE(bodies.length[0], bodies.length[1]);
  EXPECT_EQ(bodies.mass[0], bodies.length[0]);
  EXPECT_DOUBLE_EQ(bodies.inertia[0], bodies.mass[0] * bodies.length[0] * bodies.length[0] / 12);
  EXPECT_EQ(bodies.length[69], 2);
  EXPECT_TRUE(std::isinf(bodies.mass[69]) && std::isinf(bodies.inertia[69]));
  needlework_species wall{};
  EXPECT_EQ(needlework_get_species(gas, 1, &wall), NEEDLEWORK_OK);
  EXPECT_TRUE(std::isinf(wall.mass));

  const Arrays arrays(gas);
  std::vector<std::uint8_t> species(70);
  EXPECT_EQ(needlework_get_species_of_needles(gas, species.data()), NEEDLEWORK_OK);
  needlework_error error{};
  needlework_simulation* again = from(arrays, species, bodies.given(), error);
  ASSERT_NE(again, nullptr) << error.message;
  const Bodies found(again);
  EXPECT_EQ(found.length, bodies.length);
  EXPECT_EQ(found.diameter, bodies.diameter);
  EXPECT_EQ(found.mass, bodies.mass);
  EXPECT_EQ(found.inertia, bodies.inertia);
  needlework_destroy(again);
}

TEST(CBodies, OfAlikeNeedlesAreThoseOfTheirSpecies) {
  const CSimulation gas(test::cooling);
  const Bodies bodies(gas);
  EXPECT_EQ(bodies.length, std::vector<double>(60, 1));
  EXPECT_EQ(bodies.diameter, std::vector<double>(60, 0));
  EXPECT_EQ(bodies.mass, std::vector<double>(60, 1));
  EXPECT_EQ(bodies.inertia, std::vector<double>(60, 1.0 / 12));
}

TEST(CBodies, MayBeGivenInPart) {
  const CSimulation gas(test::cooling);
  const Arrays arrays(gas);
  std::vector<double> masses(60, 2);
  masses[5] = 3;
  const needlework_initial initial = arrays.initial(5);
  const needlework_bodies given{nullptr, nullptr, masses.data(), nullptr};
  needlework_error error{};
  needlework_simulation* made =
      needlework_create_with_bodies("", &initial, nullptr, nullptr, &given, 0, &error);
  ASSERT_NE(made, nullptr) << error.message;
  const Bodies bodies(made);
  EXPECT_EQ(bodies.mass, masses);
  EXPECT_EQ(bodies.inertia[5], 0.25);
  needlework_destroy(made);
}

// The scene names no spheres; those that are given are, and their masses are its.
TEST(CBodies, RoughSpheresHaveTheMomentsOfInertiaGiven) {
  const CSimulation gas(
      "needles.box = 6\ncollisions.beta = 0.5\n"
      "species = [ { name = \"s\", count = 20, length = 0, diameter = 0.8 } ]\n");
  ASSERT_NE(gas, nullptr) << gas.error.message;
  const Arrays arrays(gas);
  const std::vector<double> lengths(20, 0), diameters(20, 0.8), inertias(20, 0.05);
  const needlework_initial initial = arrays.initial(6);
  const needlework_bodies given{lengths.data(), diameters.data(), nullptr, inertias.data()};
  needlework_error error{};
  needlework_simulation* made = needlework_create_with_bodies("collisions.beta = 0.5\n", &initial,
                                                              nullptr, nullptr, &given, 0, &error);
  ASSERT_NE(made, nullptr) << error.message;
  EXPECT_EQ(Bodies(made).inertia, inertias);
  needlework_totals totals{};
  EXPECT_EQ(needlework_get_totals(made, &totals), NEEDLEWORK_OK);
  // By default spheres are homogeneous.
  EXPECT_DOUBLE_EQ(totals.t_rot, gas.totals().t_rot * 0.05 / (0.1 * (0.8 * 0.8)));
  needlework_destroy(made);
}

TEST(CBodies, ThatNoGasHasAreRefusedWithTheirNeedle) {
  const CSimulation gas(drawn);
  const Arrays arrays(gas);
  const std::vector<std::uint8_t> species = [] {
    std::vector<std::uint8_t> out(70, 0);
    std::fill(out.begin() + 60, out.end(), 1);
    return out;
  }();
  for (const auto& [value, message] :
       {std::pair(-1.0, "state: needle 7: mass = -1: expected from 1e-100 to 1e+100"),
        {std::numeric_limits<double>::infinity(), "state: needle 7: mass = inf: expected from"},
        {std::nan(""), "state: needle 7: mass = nan: expected from"}}) {
    Bodies bodies(gas);
    bodies.mass[7] = value;
    needlework_error error{};
    EXPECT_EQ(from(arrays, species, bodies.given(), error), nullptr);
    EXPECT_EQ(error.code, NEEDLEWORK_INPUT);
    EXPECT_TRUE(test::contains(error.message, message)) << error.message;
  }
}

}  // namespace
}  // namespace needlework
