// What the program says of mixtures: before, after and beside a run.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "needlework/parse.h"
#include "needlework/theory.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class MixtureCommand : public ProgramTest {
 protected:
  MixtureCommand() {
    const std::string species =
        "[[species]]\nname = \"light\"\ncount = 300\nlength = 0.5\n"
        "[[species]]\nname = \"heavy\"\ncount = 100\nlength = 1.5\nmass = 8\nk = 3\n";
    write("cooling.toml",
          "needles.box = 7\nuntil.energy_ratio = 0.2\n"
          "collisions = { epsilon = 0.8, tc_relative = 1e-3 }\n" +
              species + "[[pairs]]\nbetween = [\"heavy\", \"heavy\"]\nepsilon = 0.9\nbeta = 0.5\n");
    write("elastic.toml", "needles.box = 7\nuntil.collisions_per_needle = 60\n" + species);
  }
};

TEST_F(MixtureCommand, IsExplainedBySpeciesAndPairs) {
  EXPECT_TRUE(contains(
      output_of("check cooling.toml"),
      {"species \"light\" of length 0.5 and mass 1", "at T_tr = 1, T_rot = 1, mean free time",
       "species \"heavy\" of length 1.5 and mass 8", "inelastic (epsilon = 0.8)",
       "heavy-heavy: inelastic (epsilon = 0.9), rough (beta = 0.5)",
       "energy_ratio is met first, at time"}));
}

TEST_F(MixtureCommand, IsExplainedInJson) {
  const json check = json_of("check cooling.toml --json");
  EXPECT_TRUE(check["k"].is_null());
  EXPECT_TRUE(check["epsilon"].is_null());
  EXPECT_EQ(check["species"][1]["name"], "heavy");
  EXPECT_EQ(check["species"][1]["k"], 3);
  EXPECT_EQ(check["pairs"]["heavy-heavy"]["beta"], 0.5);
  EXPECT_EQ(check["pairs"]["light-heavy"]["epsilon"], 0.8);
  // Each needle's mean free time is in the rates of its pairs, where it counts as one of its own.
  const auto rate = [&](const char* pair) {
    return check["pairs"][pair]["collisions_per_time"].get<double>();
  };
  const double light = rate("light-light") * 300 / 299, heavy = rate("heavy-heavy") * 100 / 99;
  EXPECT_NEAR(100 / (2 * heavy + rate("light-heavy")),
              check["species"][1]["mean_free_time"].get<double>(), 1e-12);
  EXPECT_NEAR(400 / (2 * (light + rate("light-heavy") + heavy)),
              check["mean_free_time"].get<double>(), 1e-12);
  // What is forecast is what happens, as far as so few needles go.
  const json done = json_of("run cooling.toml --json");
  EXPECT_NEAR(check["expected"]["time"].get<double>() / done["time"].get<double>(), 1, 0.2);
  EXPECT_NEAR(check["expected"]["collisions"].get<double>() / done["collisions"].get<double>(), 1,
              0.2);
}

// Five needles of one species, as a mixture of equal ones, also of single ones.
TEST_F(MixtureCommand, HasTheMeanFreeTimeOfEqualNeedlesInOneSpecies) {
  write("one.toml", "needles = { count = 5, box = 4 }\nuntil.time = 1\n");
  const double one = json_of("check one.toml --json")["mean_free_time"];
  for (const std::vector<int>& counts : {std::vector{3, 2}, {4, 1}, {1, 1, 1, 1, 1}}) {
    std::string text = "needles.box = 4\nuntil.time = 1\n";
    for (std::size_t n = 0; n < counts.size(); ++n) {
      text += "[[species]]\nname = \"" + std::string(1, static_cast<char>('a' + n)) +
              "\"\ncount = " + std::to_string(counts[n]) + "\n";
    }
    write("several.toml", text);
    const json check = json_of("check several.toml --json");
    EXPECT_NEAR(check["mean_free_time"].get<double>(), one, 1e-9 * one) << text;
    EXPECT_NEAR(check["species"][1]["mean_free_time"].get<double>(), one, 1e-9 * one) << text;
  }
}

// With 40 species there are 820 pairs of them.
TEST_F(MixtureCommand, EndsWithASummaryThatAPersonReads) {
  std::string text = "needles.box = 12\nuntil.collisions_per_needle = 2\ncollisions.epsilon = 1\n";
  for (int n = 0; n < 40; ++n) {
    text += "[[species]]\nname = \"s" + std::to_string(n) +
            "\"\ncount = " + std::to_string(n == 17 ? 50 : 2) + "\n";
  }
  write("many.toml", text);
  const std::string summary = output_of("run many.toml");
  EXPECT_LT(std::ranges::count(summary, '\n'), 40) << summary;
  EXPECT_TRUE(contains(
      summary, {"s17: 50 needles",
                "s17-s17: ", "32 more, each with as few or fewer: run --json has all, in species",
                "812 more, each with as few or fewer: run --json has all, in "
                "collisions_by_pair"}));
  EXPECT_EQ(json_of("run many.toml --json")["collisions_by_pair"].size(), 820u);
}

TEST_F(MixtureCommand, EndsWithASummaryBySpecies) {
  EXPECT_TRUE(contains(output_of("run cooling.toml"),
                       {"theory", "light: 300 needles, T_tr = ", "heavy: 100 needles, T_tr = ",
                        "light-light: ", "light-heavy: ", "heavy-heavy: ", "course"}));
  EXPECT_TRUE(contains(output_of("run elastic.toml"),
                       {"exact", "light-heavy: ", "ratio to the exact rate"}));
}

TEST_F(MixtureCommand, ComparesItsRunWithTheory) {
  const json cooled = json_of("run cooling.toml --json");
  const json& theory = cooled["theory"];
  EXPECT_NEAR(theory["energy"].get<double>() / cooled["energy"].get<double>(), 1, 0.15);
  for (const std::size_t n : {0, 1}) {
    EXPECT_EQ(theory["species"][n]["name"], cooled["species"][n]["name"]);
    EXPECT_NEAR(
        theory["species"][n]["t_tr"].get<double>() / cooled["species"][n]["t_tr"].get<double>(), 1,
        0.35);
  }
  // 12000 collisions: within four standard errors, which are those of a Poisson law and more.
  const json elastic = json_of("run elastic.toml --json");
  const double exact = elastic["collision_rate_exact"];
  EXPECT_NEAR(elastic["collision_rate"].get<double>() / exact, 1, 0.06);
}

TEST_F(MixtureCommand, HasATheoryByTime) {
  const json theory = json_of("theory --json --time 0 --time 2.5 cooling.toml");
  const Scene scene = read_scene(path("cooling.toml"));
  const std::vector<theory::Temperatures> initial(2, {1, 1});
  const std::vector times{0.0, 2.5};
  const auto curve = theory::mixture_cooling(scene.composition(), 343, initial, times);
  EXPECT_EQ(theory["time"].get<std::vector<double>>(), times);
  EXPECT_EQ(theory["species"]["heavy"]["t_rot"][1], curve[1][1].t_rot);
  EXPECT_EQ(theory["energy"][0], 2.5);
  const auto rates = theory::mixture_rates(scene.composition(), 343, initial);
  EXPECT_EQ(theory["collisions_per_time"]["light-heavy"], rates.collisions[1]);
  EXPECT_EQ(theory["t_tr_per_time"]["light"], rates.temperatures[0].t_tr);

  EXPECT_TRUE(
      contains(run("theory cooling.toml").out, {"light-heavy", "T_tr heavy", "T_rot light"}));
  for (const char* option :
       {"--k 6", "--epsilon 0.5", "--beta 0", "--density 1", "--t-rot0 0", "--tau 1"}) {
    EXPECT_TRUE(run(std::string("theory ") + option + " cooling.toml")
                    .fails(2, "expected none beside a scene of several species"))
        << option;
  }
}

TEST_F(MixtureCommand, IsAudited) {
  const json audit = json_of(
      "audit --json --set until.energy_ratio=none --set until.collisions_per_needle=4 "
      "cooling.toml");
  EXPECT_EQ(audit["wrong_rule"], 0);
  EXPECT_EQ(audit["collisions"], 800);
  EXPECT_GT(audit["checked"].get<int>(), 100000);
}

TEST_F(MixtureCommand, HasAReportOfAllObservables) {
  const Outcome made =
      run("run --quiet cooling.toml --out run.h5 --set output.frames=2 --set "
          "'output.observables=[\"fields\", \"profiles\", \"flow_order\", \"distributions\", "
          "\"alignment\", \"velocity_moments\", \"temperature_by_axis\", \"pair_correlation\", "
          "\"structure_factor\", \"displacement\", \"collision_statistics\"]'");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Outcome page = run("report run.h5 -o page.html");
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_EQ(run("info run.h5").exit_code, 0);
}

}  // namespace
}  // namespace needlework
