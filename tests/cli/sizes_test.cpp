// What the program says of bodies that differ within a species, and of fixed ones.
#include <cmath>
#include <string>

#include "tests/cli/program.h"

namespace needlework {
namespace {

class SizesCommand : public ProgramTest {
 protected:
  SizesCommand() {
    const std::string lognormal =
        "[[species]]\nname = \"rods\"\ncount = 200\nlength.distribution = \"lognormal\"\n"
        "length.mean = 1\nlength.width = 0.3\nmass.density = 1\n";
    write("sizes.toml", "needles.box = 6\nuntil.collisions_per_needle = 12\n" + lognormal);
    write("fixed.toml",
          "needles.box = 8\nuntil.collisions_per_needle = 8\n"
          "[[species]]\nname = \"moving\"\ncount = 100\n"
          "[[species]]\nname = \"still\"\ncount = 300\nfixed = true\n");
    write("spheres.toml",
          "needles.box = 5\nuntil.collisions_per_needle = 5\n[[species]]\nname = \"balls\"\n"
          "count = 100\nlength = 0\ndiameter.distribution = \"lognormal\"\ndiameter.mean = 0.6\n"
          "diameter.width = 0.3\nmass.density = 1\n");
  }
};

TEST_F(SizesCommand, ExplainsWhatIsDrawnAndWhatCameOfIt) {
  EXPECT_TRUE(contains(output_of("check sizes.toml"),
                       {"200, k = 6, uniform rods, species \"rods\" of length 0.",
                        "length lognormal of mean 1, width 0.3: drawn mean 0.", ", width 0.",
                        "mass of density 1: drawn mean 0.", "exact rate", "on average"}));
  const auto check = json_of("check sizes.toml --json");
  const auto& species = check["species"][0];
  EXPECT_EQ(species["k"], 6);
  EXPECT_EQ(check["k"], 6);
  const auto& length = species["sizes"]["length"];
  EXPECT_EQ(length["drawn"]["distribution"], "lognormal");
  EXPECT_EQ(length["drawn"]["width"], 0.3);
  EXPECT_NEAR(length["width"].get<double>(), 0.3, 0.05);
  EXPECT_EQ(length["mean"], species["length"]);
  EXPECT_LT(length["least"], length["mean"]);
  EXPECT_EQ(species["sizes"]["mass"]["drawn"]["density"], 1);
  EXPECT_FALSE(species["sizes"].contains("diameter"));
  EXPECT_FALSE(species.contains("fixed"));
}

// And compares the rate with that of the bodies drawn.
TEST_F(SizesCommand, SumsUpARunBesideTheExactRate) {
  const Outcome done = run("run sizes.toml");
  EXPECT_TRUE(contains(done.out, {"elastic sizes\n",
                                  "bodies        length lognormal of mean 1, width 0.3: drawn mean",
                                  ", exact ", "ratio "}));
  EXPECT_FALSE(contains(done.out, "theory"));
  const auto result = json_of("run sizes.toml --json --quiet");
  EXPECT_TRUE(result["theory"].is_null());
  EXPECT_EQ(result["effects"], "elastic sizes");
  const double ratio =
      result["collision_rate"].get<double>() / result["collision_rate_exact"].get<double>();
  EXPECT_NEAR(ratio, 1, 0.08);
  EXPECT_EQ(result["species"][0]["sizes"]["length"]["drawn"]["mean"], 1);
  EXPECT_EQ(json_of("check sizes.toml --json")["collision_rate_exact"],
            result["collision_rate_exact"]);
}

TEST_F(SizesCommand, ExplainsFixedOnesWithoutCountingThem) {
  const std::string text = output_of("check fixed.toml");
  EXPECT_TRUE(contains(
      text, {"300, thin needles, species \"still\" of length 1, fixed",
             "T_tr = 1, T_rot = 1, E = 2.5 per needle that moves", "of needles that move",
             "in equilibrium of 100 needles that move among 300 fixed, which count, too",
             "collisions_per_needle = 8, of all 400 needles", "at the rate of the start"}));
  EXPECT_FALSE(contains(text, "still-still"));
  EXPECT_FALSE(contains(text, "at T_tr = 0"));
  const auto check = json_of("check fixed.toml --json");
  EXPECT_EQ(check["energy"], 2.5);
  EXPECT_EQ(check["t_tr"], 1);
  EXPECT_EQ(check["species"][1]["fixed"], true);
  EXPECT_TRUE(check["species"][1]["mass"].is_null());
  EXPECT_TRUE(check["species"][1]["k"].is_null());
  EXPECT_TRUE(check["species"][1]["mean_free_time"].is_null());
  // Of a needle that moves: with fixed ones once, with others twice.
  const auto rate = [&](const char* pair) {
    return check["pairs"][pair]["collisions_per_time"].get<double>();
  };
  EXPECT_NEAR(check["mean_free_time"].get<double>(),
              100 / (2 * rate("moving-moving") * 100 / 99 + rate("moving-still")), 1e-9);
  EXPECT_NEAR(check["expected"]["time"].get<double>(),
              8 * 400 / (2 * (rate("moving-moving") + rate("moving-still"))), 1e-9);
}

TEST_F(SizesCommand, SumsUpARunAmongFixedOnesWithoutTheory) {
  for (const char* meet : {"", " --set collisions.epsilon=0.9 --set collisions.tc_relative=1e-3"}) {
    const Outcome done = run(std::string("run fixed.toml") + meet);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_TRUE(contains(done.out, {"still: 300 needles, fixed", "fixed ones among them"}));
    EXPECT_FALSE(contains(done.out, ", theory"));
    EXPECT_FALSE(contains(done.out, "nan"));
  }
  EXPECT_TRUE(contains(run("run fixed.toml --set collisions.epsilon=0.9 --set "
                           "collisions.tc_relative=1e-3")
                           .out,
                       "none: that of cooling does not apply to fixed bodies"));
  const auto result = json_of("run fixed.toml --json --quiet");
  EXPECT_NEAR(result["collision_rate"].get<double>(), result["collision_rate_exact"].get<double>(),
              0.1 * result["collision_rate"].get<double>());
  EXPECT_EQ(result["species"][1]["fixed"], true);
  EXPECT_EQ(result["effects"], "elastic mixture fixed");
}

TEST_F(SizesCommand, SaysWhereTheoryDoesNotApply) {
  EXPECT_TRUE(contains(output_of("check fixed.toml --set collisions.epsilon=0.9"),
                       "the theory of a gas that cools does not apply to fixed bodies"));
  EXPECT_TRUE(contains(output_of("check sizes.toml --set collisions.epsilon=0.9"),
                       "does not apply to bodies that differ within a species"));
  for (const char* scene : {"sizes.toml", "fixed.toml"}) {
    EXPECT_TRUE(contains(output_of(std::string("theory ") + scene),
                         {"collisions per time", "no course: the theory of a gas that cools"}));
    const auto theory = json_of(std::string("theory --json ") + scene);
    EXPECT_FALSE(theory.contains("t_tr"));
    EXPECT_TRUE(theory.contains("no_course_of"));
    EXPECT_EQ(run(std::string("theory --time 3 ") + scene).exit_code, 2);
    EXPECT_EQ(run(std::string("theory --boltzmann single ") + scene).exit_code, 2);
  }
}

TEST_F(SizesCommand, GivesThePressureOfSpheresThatDiffer) {
  const auto theory = json_of("theory --json spheres.toml"),
             check = json_of("check spheres.toml --json");
  const double packing = check["packing_fraction"].get<double>();
  EXPECT_EQ(theory["rods"]["packing_fraction"], packing);
  const double fluid = theory["rods"]["pressure_of_fluid"].get<double>() / (100 / 125.0);
  const double single =
      (1 + packing + packing * packing - packing * packing * packing) / std::pow(1 - packing, 3);
  EXPECT_LT(fluid, single);
  EXPECT_GT(fluid, 1 + (single - 1) * 0.8);
  EXPECT_TRUE(contains(output_of("theory spheres.toml"), " of the fluid"));
  // Elastic, in equilibrium: there is no cooling that theory could be asked about.
  const std::string done = output_of("run spheres.toml");
  EXPECT_TRUE(contains(done, "  rate   "));
  EXPECT_FALSE(contains(done, "theory"));
  EXPECT_TRUE(contains(output_of("check spheres.toml"), "spheres of different diameters"));
}

TEST_F(SizesCommand, SaysInFilesHowBodiesDiffer) {
  ASSERT_EQ(run("run sizes.toml --quiet --out sizes.h5").exit_code, 0);
  EXPECT_TRUE(contains(output_of("info sizes.h5"), {"  length of mean 0.", "; mass of mean 0."}));
  ASSERT_EQ(run("run fixed.toml --quiet --out fixed.h5").exit_code, 0);
  EXPECT_TRUE(contains(output_of("info fixed.h5"), "  still: fixed"));
  EXPECT_EQ(run("report fixed.h5 -o page.html").exit_code, 0);
}

TEST_F(SizesCommand, ObservesClassesOfSize) {
  const Outcome done =
      run("run sizes.toml --quiet --out sizes.h5 --set output.size_classes=4 --set "
          "'output.observables=[\"displacement\"]'");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(contains(output_of("info sizes.h5"),
                       {"by_size", "mean_size", "Translational temperature of each class"}));
  EXPECT_EQ(run("report sizes.h5 -o page.html").exit_code, 0);
  EXPECT_EQ(run("check sizes.toml --set output.size_classes=65").exit_code, 3);
  // A run that continues has the classes that it had.
  ASSERT_EQ(run("resume sizes.h5 --quiet --set until.collisions_per_needle=20").exit_code, 0);
}

}  // namespace
}  // namespace needlework
