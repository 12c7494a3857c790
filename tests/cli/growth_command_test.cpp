// Bodies that grow in the commands of the program: before, while and after they do.
#include <cmath>
#include <string>
#include <vector>

#include "needlework/h5md.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

class GrowthCommand : public ProgramTest {
 protected:
  GrowthCommand() {
    write("grow.toml",
          "needles.box = 6\ndriving.growth = { rate = 0.05, until_packing = 0.3 }\n"
          "until.time = 1000\noutput = { file = 'g.h5', series_every = 0.2, "
          "observables = ['contact_network'] }\n"
          "[[species]]\nname = 'small'\ncount = 40\nlength = 0\ndiameter = 0.6\n"
          "[[species]]\nname = 'large'\ncount = 40\nlength = 0\ndiameter = 0.9\n");
  }
  static constexpr double start = 40 * (0.216 + 0.729) * 0.5235987755982988 / 216;
  static double largest() { return std::cbrt(0.3 / start); }
};

TEST_F(GrowthCommand, SaysHowFarItGrows) {
  const auto driving = json_of("check grow.toml --json")["driving"]["growth"];
  EXPECT_EQ(driving["rate"], 0.05);
  EXPECT_EQ(driving["until_packing"], 0.3);
  EXPECT_TRUE(driving["until_pressure"].is_null());
  EXPECT_NEAR(driving["largest"].get<double>(), largest(), 1e-12);
  EXPECT_EQ(driving["largest_by"], "grown");
  const std::string text = run("check grow.toml").out;
  EXPECT_TRUE(
      contains(text, "all bodies grow, by a rate of 0.05, until a packing fraction of 0.3"));
  const std::string pressed = run("check grow.toml --set driving.growth.until_pressure=1e4").out;
  EXPECT_TRUE(contains(pressed, "until a packing fraction of 0.3 or P V / (N T) = 10000"));
  // Spheres of a diameter of 6/2.01 would fill the box.
  const auto room = json_of(
      "check grow.toml --json --set species.small.count=1 --set species.large.count=1 "
      "--set driving.growth={rate=0.1}");
  EXPECT_EQ(room["driving"]["growth"]["largest_by"], "no_room");
  EXPECT_NEAR(room["driving"]["growth"]["largest"].get<double>(), 6 / 2.01 / 0.9, 1e-9);
}

TEST_F(GrowthCommand, EndsWithoutAnotherEnd) {
  const std::string none = " --set until.time=none";
  EXPECT_TRUE(contains(run("check grow.toml").out, "time = 1000 or the end of growth"));
  EXPECT_TRUE(contains(run("check grow.toml" + none).out, "ends            the end of growth"));
  const std::string whole = hash_of("run grow.toml --out whole.h5" + none);
  EXPECT_NE(hash_of("run grow.toml --out a.h5 --set until.time=2"), whole);
  EXPECT_EQ(hash_of("resume a.h5" + none), whole);
  EXPECT_TRUE(contains(run("resume a.h5").err, "nothing to do; a new scene with initial.file"));
  // Nor does it take a collision.
  write("one.toml",
        "needles.box = 6\ndriving.growth = { rate = 0.3, until_packing = 0.02 }\n"
        "[[species]]\nname = 'one'\ncount = 1\nlength = 0\ndiameter = 1\n");
  const auto alone = json_of("run one.toml --json --quiet");
  EXPECT_EQ(alone["stop"], "grown");
  EXPECT_EQ(alone["collisions"], 0);
}

TEST_F(GrowthCommand, GivesSizesPackingAndPressure) {
  const auto result = json_of("run grow.toml --json --quiet");
  EXPECT_EQ(result["stop"], "grown");
  EXPECT_EQ(result["effects"], "elastic mixture rods growth");
  EXPECT_NEAR(result["growth"]["scale"].get<double>(), largest(), 1e-12);
  EXPECT_NEAR(result["growth"]["packing_fraction"].get<double>(), 0.3, 1e-12);
  EXPECT_EQ(result["rods"]["packing_fraction"], result["growth"]["packing_fraction"]);
  EXPECT_GT(result["growth"]["pressure"].get<double>(), 2);
  double sum = 0;
  for (const auto& [name, energy] : result["energy_budget"].items())
    if (energy.is_number()) sum += energy.get<double>();
  EXPECT_NEAR(sum, result["energy"].get<double>() - result["energy_initial"].get<double>(), 1e-12);
  EXPECT_GT(result["energy_budget"]["growth"].get<double>(), 0);
  const std::string text = run("run grow.toml --force").out;
  EXPECT_TRUE(contains(text, "grew to its packing fraction"));
  EXPECT_TRUE(contains(text, "growth"));
  EXPECT_TRUE(contains(text, "packing fraction 0.3"));
  EXPECT_TRUE(contains(text, ", as P V / (N T)\n"));
  EXPECT_TRUE(contains(run("info g.h5").out, "Sizes of all bodies in those of the start"));
}

TEST_F(GrowthCommand, ShowsPackingAndPressureMeanwhile) {
  const Outcome shown = run("run grow.toml --progress-every 0 --set until.time=3");
  EXPECT_TRUE(contains(shown.err, ", packing 0.09"));
}

TEST_F(GrowthCommand, GoesOnBitForBit) {
  const std::string whole = hash_of("run grow.toml");
  const std::string part = hash_of("run grow.toml --force --set until.collisions_per_needle=9");
  EXPECT_NE(part, whole);
  EXPECT_EQ(hash_of("resume g.h5 --set until.collisions_per_needle=none"), whole);
}

TEST_F(GrowthCommand, ExportsPresentSizes) {
  ASSERT_EQ(run("run grow.toml --quiet").exit_code, 0);
  for (const std::string name : {"a.xyz", "a.dump", "a.xml"}) {
    const Outcome exported = run("export g.h5 " + name + " --frame last");
    ASSERT_EQ(exported.exit_code, 0) << name << exported.err;
    const Outcome imported = run("import " + name + " --out " + name + ".folder");
    ASSERT_EQ(imported.exit_code, 0) << name << imported.err;
    const State state = io::FrameFile(path(name + ".folder/state.h5")).read(0);
    ASSERT_EQ(state.size(), 80u);
    for (std::size_t i = 0; i < state.size(); ++i) {
      const double of_species = state.bodies.diameter[state.species.empty() ? 0 : state.species[i]];
      const double diameter =
          state.own_bodies.diameter.empty() ? of_species : state.own_bodies.diameter[i];
      EXPECT_NEAR(diameter, (i < 40 ? 0.6 : 0.9) * largest(), 1e-6) << name << i;
    }
  }
  EXPECT_EQ(run("view g.h5 -o a.svg").exit_code, 0);
  EXPECT_EQ(run("report g.h5 -o a.html").exit_code, 0);
}

TEST_F(GrowthCommand, HasMeansOverSeeds) {
  write("grid.toml", "scene = 'grow.toml'\nseeds = [1, 2]\n");
  const auto results = json_of("sweep --json grid.toml --out all");
  const auto& point = results["points"][0]["results"];
  EXPECT_NEAR(point["growth_packing_fraction"]["mean"].get<double>(), 0.3, 1e-12);
  EXPECT_GT(point["growth_pressure"]["mean"].get<double>(), 2);
  EXPECT_GT(point["network_rattlers"]["mean"].get<double>(), 0);
}

}  // namespace
}  // namespace needlework
