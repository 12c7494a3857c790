// Thin needles beside rods and spheres, and gases of bodies that differ beside fixed ones, from
// command to command.
#include <string>

#include "tests/cli/program.h"

namespace needlework {
namespace {

// Thin needles, which pass through each other's places, rods and spheres that none may enter.
const std::string mixed =
    "needles = { box = 8, seed = 2 }\nuntil.collisions_per_needle = 6\n"
    "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\noutput.events = true\n"
    "[[species]]\nname = \"thin\"\ncount = 60\nmass = 0.5\n"
    "[[species]]\nname = \"rods\"\ncount = 40\nlength = 1.5\ndiameter = 0.4\n"
    "[[species]]\nname = \"balls\"\ncount = 30\nlength = 0\ndiameter = 1\nmass = 3\n";
// Needles and rods that differ among fixed spheres that differ.
const std::string sizes =
    "needles = { box = 8, seed = 2 }\nuntil.collisions_per_needle = 6\noutput.events = true\n"
    "[[species]]\nname = \"thin\"\ncount = 60\nmass.density = 2\n"
    "length = { distribution = \"lognormal\", mean = 1, width = 0.3 }\n"
    "[[species]]\nname = \"rods\"\ncount = 40\nmass.density = 5\ndiameter.aspect = 4\n"
    "length = { distribution = \"gamma\", mean = 1, width = 0.4 }\n"
    "[[species]]\nname = \"still\"\ncount = 40\nlength = 0\nfixed = true\noverlap = true\n"
    "diameter = { distribution = \"powerlaw\", min = 0.3, max = 2, exponent = 2 }\n";

struct Gas {
  const char* name;
  const std::string& text;
  const char* effects;
  const char* dynamo;  ///< why there is no file of it
};

class BesideRods : public ProgramTest, public testing::WithParamInterface<Gas> {
 protected:
  BesideRods() { write("s.toml", GetParam().text); }
};

INSTANTIATE_TEST_SUITE_P(
    Each, BesideRods,
    testing::Values(Gas{"Mixed", mixed, "inelastic tc mixture rods", "needles beside spheres"},
                    Gas{"Sizes", sizes, "elastic mixture rods sizes fixed", "still is fixed"}),
    [](const auto& each) { return each.param.name; });

TEST_P(BesideRods, GoOnBitForBit) {
  const auto whole = json_of("run s.toml --json --quiet");
  EXPECT_EQ(whole["effects"], GetParam().effects);
  const std::string part = " --set until.collisions_per_needle=";
  EXPECT_NE(hash_of("run s.toml --out run.h5" + part + "2.5"), whole["trajectory_hash"]);
  EXPECT_EQ(hash_of("resume run.h5" + part + "6"), whole["trajectory_hash"]);
  for (const auto& [pair, count] : whole["collisions_by_pair"].items())
    EXPECT_EQ(count == 0, pair == "still-still") << pair;
}

TEST_P(BesideRods, AreAudited) {
  const auto findings = json_of("audit s.toml --json --quiet --set until.collisions_per_needle=3");
  EXPECT_EQ(findings["undecided"], 0);
  EXPECT_GT(findings["contacts"], 190);
  EXPECT_TRUE(findings["differences"].empty()) << findings;
}

TEST_P(BesideRods, AreListedDrawnAndExported) {
  output_of("run s.toml --out run.h5 --quiet --set until.collisions_per_needle=2");
  EXPECT_TRUE(contains(output_of("info run.h5"), {"thin", "rods", "arms", "/particles/needles: "}));
  output_of("view run.h5 --out run.svg");
  output_of("report run.h5 --out run.html");
  for (const char* name : {"run.vtkhdf", "run.pvd"})
    output_of(std::string("export run.h5 ") + name);
  // The same bodies at the same temperatures, which collide alike.
  const std::string on =
      " --set until.collisions_per_needle=2 --set collisions.epsilon=0.9 --set "
      "collisions.tc_relative=1e-3";
  write("go_on.toml", "initial.file = \"run.h5\"\n");
  const std::string expected = hash_of("run go_on.toml" + on);
  for (const std::string name : {"run.xyz", "run.dump"}) {
    output_of("export run.h5 " + name);
    output_of("import --force --out imported " + name);
    EXPECT_EQ(hash_of("run imported/scene.toml" + on), expected) << name;
  }
  EXPECT_TRUE(run("export run.h5 run.xml").fails(3, GetParam().dynamo));
  EXPECT_TRUE(run("export run.h5 run.data").fails(3, "rods of finite width"));
}

}  // namespace
}  // namespace needlework
