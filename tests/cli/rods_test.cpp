// Rods of finite width in the commands of the program: before, after and beside a run.
#include <cmath>
#include <string>

#include "tests/cli/program.h"

namespace needlework {
namespace {

class RodsCommand : public ProgramTest {
 protected:
  RodsCommand() {
    write("rods.toml",
          "needles.box = 8\ncollisions = { epsilon = 0.9, tc_relative = 1e-3 }\n"
          "until.collisions_per_needle = 6\n"
          "[[species]]\nname = \"balls\"\ncount = 60\nlength = 0\nmass = 2\ndiameter = 1.2\n"
          "[[species]]\nname = \"rods\"\ncount = 40\nlength = 2\ndiameter = 0.5\n");
  }
  // The run, in the file rods.h5.
  std::string hash_to(double collisions_per_needle) const {
    return hash_of(
        "run rods.toml --force --set output.file=rods.h5 --set output.frames=2 --set "
        "until.collisions_per_needle=" +
        std::to_string(collisions_per_needle));
  }
};

TEST_F(RodsCommand, GoesOnBitForBit) {
  const std::string whole = hash_to(6);
  EXPECT_NE(hash_to(2.5), whole);
  EXPECT_EQ(hash_of("resume rods.h5 --set until.collisions_per_needle=6"), whole);
}

TEST_F(RodsCommand, SaysWhatIsKnownOfThem) {
  const auto check = json_of("check rods.toml --json");
  EXPECT_NEAR(check["packing_fraction"].get<double>(), 0.141822, 1e-6);
  EXPECT_EQ(check["species"][0]["diameter"], 1.2);
  // Of balls 3/2, of rods 5/2.
  EXPECT_NEAR(check["energy"].get<double>(), 1.5 + 0.4, 1e-12);
  const auto summary = json_of("run rods.toml --json --quiet");
  EXPECT_NEAR(summary["energy_initial"].get<double>(), 1.5 + 0.4, 1e-12);
  EXPECT_EQ(summary["species"][0]["t_rot"], 0);
  EXPECT_DOUBLE_EQ(summary["t_rot"].get<double>(),  // that of what turns
                   summary["species"][1]["t_rot"].get<double>());
  EXPECT_EQ(check["t_rot"], 1);
  EXPECT_EQ(summary["effects"], "inelastic tc mixture rods");
  EXPECT_EQ(summary["placement"].get<std::string>().substr(0, 9), "100 rods ");
  EXPECT_TRUE(summary["collision_rate_exact"].is_null());
  const Outcome elastic = run("run rods.toml --set collisions.epsilon=1");
  EXPECT_FALSE(contains(elastic.out, "nan"));
}

TEST_F(RodsCommand, GivesTheirPressure) {
  write("spheres.toml",
        "needles.box = 6\nuntil.collisions_per_needle = 60\n"
        "[[species]]\nname = \"balls\"\ncount = 80\nlength = 0\ndiameter = 1\n");
  const auto result = json_of("run spheres.toml --json --quiet");
  const auto& rods = result["rods"];
  EXPECT_NEAR(rods["packing_fraction"].get<double>(), 80 * 0.523598776 / 216, 1e-9);
  // n T Z with Z = 2.34 of Carnahan and Starling.
  EXPECT_NEAR(rods["pressure"].get<double>(), 80 * 2.34 / 216, 0.06);
  const double virial = rods["virial"].get<double>(), time = result["time"].get<double>();
  EXPECT_NEAR(rods["pressure"].get<double>(), (80 + virial / (3 * time)) / 216, 1e-9);
  EXPECT_TRUE(contains(run("run spheres.toml").out, "packing fraction 0.19393, virial "));
  const auto theory = json_of("theory spheres.toml --json")["rods"];
  EXPECT_NEAR(theory["second_virial"].get<double>(), 2 * M_PI / 3, 1e-9);
  EXPECT_NEAR(theory["pressure"].get<double>(), 80.0 / 216 * (1 + 80.0 / 216 * 2 * M_PI / 3), 1e-9);
  EXPECT_TRUE(contains(run("theory spheres.toml").out, "second virial coefficient B = 2.0943951"));
  // Out of equilibrium there is none.
  EXPECT_TRUE(json_of("theory rods.toml --json")["rods"]["pressure"].is_null());
}

// Between walls it is what these feel, which gravity along their axis makes depend on the height.
TEST_F(RodsCommand, GivesThePressureOnWalls) {
  const std::string scene =
      "needles.box = [1.2, 8, 8]\nuntil.time = 30\ncollisions.epsilon = 1\n"
      "[[species]]\nname = \"balls\"\ncount = 20\nlength = 0\ndiameter = 1\n"
      "[[walls]]\naxis = \"x\"\nside = \"both\"\n";
  write("slit.toml", scene);
  const auto result = json_of("run slit.toml --json --quiet");
  const auto on = [&](std::size_t n) { return result["walls"][n]["pressure"].get<double>(); };
  EXPECT_NEAR(result["rods"]["pressure"].get<double>(), (on(0) + on(1)) / 2, 1e-12 * on(0));
  EXPECT_EQ(result["rods"]["pressure_meaning"], "mean over the run, on the walls");
  // Far more than N T / V: their centres have a sixth of the slit.
  EXPECT_GT(on(0), 4.0 * 20 / (1.2 * 64));
  const std::string falling = " --set forces.gravity=[-1,0,0]";
  const auto none = json_of("run slit.toml --json --quiet" + falling)["rods"];
  EXPECT_TRUE(none["pressure"].is_null());
  EXPECT_EQ(none["pressure_meaning"],
            "none: under gravity it depends on the height; walls have theirs");
  EXPECT_TRUE(contains(run("run slit.toml" + falling).out, "pressure: none: under gravity"));
  EXPECT_FALSE(contains(run("run slit.toml").out, "T_rot"));  // of spheres alone
}

TEST_F(RodsCommand, DrawsThemAsWideAsTheyAre) {
  hash_to(1);
  EXPECT_EQ(run("view rods.h5 -o rods.svg --colour none").exit_code, 0);
  const std::string svg = read("rods.svg");
  EXPECT_TRUE(contains(svg, "of diameter 1.2, 0.5"));
  EXPECT_EQ(run("report rods.h5 -o rods.html").exit_code, 0);
}

TEST_F(RodsCommand, AuditsThem) {
  const auto findings = json_of("audit rods.toml --json --quiet");
  EXPECT_EQ(findings["undecided"], 0);
  EXPECT_EQ(findings["contacts"], 300);
  EXPECT_TRUE(findings["differences"].empty()) << findings;
}

TEST_F(RodsCommand, ExportsAndImportsThem) {
  hash_to(1);
  for (const char* name : {"rods.vtkhdf", "rods.pvd"}) {
    const Outcome exported = run(std::string("export rods.h5 ") + name);
    EXPECT_EQ(exported.exit_code, 0) << exported.err;
  }
  const std::string on = " --set until.collisions_per_needle=1 --set collisions.tc_relative=1e-3";
  std::string first;
  for (const std::string name : {"rods.xyz", "rods.dump"}) {
    EXPECT_EQ(run("export rods.h5 " + name).exit_code, 0);
    const Outcome imported = run("import " + name + " --out " + name + "-folder");
    EXPECT_EQ(imported.exit_code, 0) << imported.err;
    const std::string scene = read(name + "-folder/scene.toml");
    EXPECT_TRUE(
        contains(scene, {"length = 0\nmass = 2\nk = 6\ndiameter = 1.2\n", "diameter = 0.5\n"}));
    const auto result = json_of("run " + name + "-folder/scene.toml --json --quiet" + on +
                                " --set collisions.epsilon=0.9");
    EXPECT_EQ(result["collisions"], 50);
    EXPECT_NEAR(result["rods"]["packing_fraction"].get<double>(), 0.141822, 1e-6);
    if (first.empty()) first = result["trajectory_hash"];
    EXPECT_EQ(result["trajectory_hash"], first) << name;
  }
  for (const char* name : {"rods.data", "rods.xml"}) {
    const Outcome refused = run(std::string("export rods.h5 ") + name);
    EXPECT_EQ(refused.exit_code, 3) << name;
    EXPECT_FALSE(exists(name));
  }
}

}  // namespace
}  // namespace needlework
