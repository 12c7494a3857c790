// The exact collision rate that `run` and `check` give: of which gases, and that it is the
// theory's.
#include <cmath>
#include <string>
#include <vector>

#include "needlework/theory.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class ExactRate : public ProgramTest {
 protected:
  // Of 12 needles in a box of 4 x 5 x 1.5 at temperature 2, between walls along z.
  std::string between_walls(const std::string& wall, const std::string& more = "") const {
    return "needles = { count = 12, box = [4, 5, 1.5] }\ninitial = { t_tr = 2, t_rot = 2 }\n"
           "until.time = 3\n" +
           more + "[[walls]]\naxis = \"z\"\nside = \"both\"\n" + wall;
  }
  json of(const std::string& scene) {
    write("gas.toml", scene);
    const json check = json_of("check gas.toml --json")["collision_rate_exact"];
    const json run = json_of("run gas.toml --json --quiet")["collision_rate_exact"];
    EXPECT_EQ(check.is_null(), run.is_null());
    if (!check.is_null()) {
      EXPECT_NEAR(check.get<double>(), run.get<double>(), 1e-10);
    }
    return run;
  }
};

TEST_F(ExactRate, IsThatOfAFiniteGasBetweenWalls) {
  Species needle;
  // Momentum is conserved along x and y alone.
  const double expected = theory::pair_factor_between_walls(needle, {1, 1}, needle, {1, 1}, 1.5) *
                          theory::equilibrium_rate(12, 30, 12 * 5, 6, 2);
  EXPECT_NEAR(of(between_walls("")).get<double>(), expected, 1e-10);
  EXPECT_TRUE(contains(run("check gas.toml").out, "exact rate"));
  EXPECT_TRUE(contains(run("run gas.toml").out, ", exact "));
}

// Of an inelastic gas, which collides as often as one without walls does at another density.
TEST_F(ExactRate, SetsTheTimeThatIsExpectedBetweenWalls) {
  write("gas.toml",
        "needles = { count = 500, box = [8, 8, 1.5] }\nuntil.energy_ratio = 0.1\n"
        "collisions = { epsilon = 0.8, tc_relative = 1e-3 }\n"
        "[[walls]]\naxis = \"z\"\nside = \"both\"\n");
  write("open.toml",
        "needles = { count = 500, box = [8, 4, 3] }\nuntil.energy_ratio = 0.1\n"
        "collisions = { epsilon = 0.8, tc_relative = 1e-3 }\n");
  Species needle;
  const double factor = theory::pair_factor_between_walls(needle, {1, 1}, needle, {1, 1}, 1.5);
  const json walled = json_of("check gas.toml --json"), open = json_of("check open.toml --json");
  EXPECT_NEAR(walled["mean_free_time"].get<double>() * factor, open["mean_free_time"].get<double>(),
              1e-12);
  EXPECT_NEAR(walled["expected"]["time"].get<double>() * factor,
              open["expected"]["time"].get<double>(), 1e-9);
}

TEST_F(ExactRate, IsThatOfEachTwoSpeciesBetweenWalls) {
  const std::string scene =
      "needles.box = [4, 5, 1.5]\nuntil.time = 3\n"
      "[[species]]\nname = \"short\"\ncount = 8\nlength = 0.7\nmass = 2\n"
      "[[species]]\nname = \"long\"\ncount = 5\nk = 3\n"
      "[[walls]]\naxis = \"z\"\nside = \"both\"\n";
  Species small, large;
  small.count = 8;
  small.length = 0.7;
  small.mass = 2;
  large.count = 5;
  large.k = 3;
  const Composition both({small, large}, {});
  const auto factor = [](const Species& a, const Species& b) {
    return theory::pair_factor_between_walls(a, {1, 1}, b, {1, 1}, 1.5);
  };
  const std::vector<double> open = theory::mixture_equilibrium_rates(both, 30, 13 * 2.5, 2);
  const double all = open[both.pair_index(0, 0)] * factor(small, small) +
                     open[both.pair_index(0, 1)] * factor(small, large) +
                     open[both.pair_index(1, 1)] * factor(large, large);
  EXPECT_NEAR(of(scene).get<double>(), 2 * all / 13, 1e-9);
  EXPECT_TRUE(contains(run("run gas.toml").out, "ratio to the exact rate"));
}

// Velocities are those of Maxwell then.
TEST_F(ExactRate, IsThatOfTheTemperatureOfAHeatBath) {
  Species needle;
  const double expected = theory::pair_factor_between_walls(needle, {1, 1}, needle, {1, 1}, 1.5) *
                          theory::collision_rate(11.0 / 30, {2, 2}, 6);
  const std::string thermostat = "driving.andersen = { rate = 1, temperature = 2 }\n";
  EXPECT_NEAR(of(between_walls("temperature = 2\n")).get<double>(), expected, 1e-10);
  EXPECT_NEAR(of(between_walls("", thermostat)).get<double>(), expected, 1e-10);
  EXPECT_TRUE(of(between_walls("temperature = 3\n", thermostat)).is_null());
}

TEST_F(ExactRate, IsNotClaimedWhereItIsNotKnown) {
  for (const char* wall :
       {"epsilon = 0.9\n", "temperature = 3\n", "motion = { amplitude = 0.1, frequency = 1 }\n",
        "[[walls]]\naxis = \"x\"\nside = \"both\"\n"}) {
    EXPECT_TRUE(of(between_walls(wall)).is_null()) << wall;
  }
  for (const char* more :
       {"forces.gravity = [0, 0, -1]\n", "driving.andersen = { rate = 1, temperature = 3 }\n",
        "driving.kicks = { every = 1, translational = 1, rotational = 1 }\n",
        "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n"}) {
    EXPECT_TRUE(of(between_walls("", more)).is_null()) << more;
  }
}

}  // namespace
}  // namespace needlework
