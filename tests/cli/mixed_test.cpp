// What the program says of thin needles among spheres, and of needles that pass through each other.
#include <string>
#include <vector>

#include "needlework/h5md.h"
#include "needlework/parse.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using nlohmann::json;

class MixedCommand : public ProgramTest {
 protected:
  MixedCommand() {
    write("mixed.toml",
          "needles.box = 7\nuntil.collisions_per_needle = 4\n"
          "[[species]]\nname = \"needles\"\ncount = 150\n"
          "[[species]]\nname = \"ghosts\"\ncount = 50\nlength = 0.5\n"
          "[[species]]\nname = \"balls\"\ncount = 20\nlength = 0\ndiameter = 1\nmass = 4\n"
          "[[pairs]]\nbetween = [\"ghosts\", \"ghosts\"]\nmeet = false\n"
          "[[pairs]]\nbetween = [\"needles\", \"ghosts\"]\nmeet = false\n");
  }
};

TEST_F(MixedCommand, IsExplained) {
  EXPECT_TRUE(contains(output_of("check mixed.toml"),
                       {"20, spheres of diameter 1", "ghosts-ghosts: pass through each other",
                        "needles-ghosts: pass through each other"}));
  const json check = json_of("check mixed.toml --json");
  EXPECT_EQ(check["pairs"]["ghosts-ghosts"]["meet"], false);
  EXPECT_EQ(check["pairs"]["ghosts-ghosts"]["collisions_per_time"], 0);
  EXPECT_FALSE(check["pairs"]["needles-balls"].contains("meet"));
  EXPECT_GT(check["pairs"]["needles-balls"]["collisions_per_time"], 0);
  EXPECT_TRUE(check["expected"].is_null());
  const json theory = json_of("theory --scene mixed.toml --json");
  EXPECT_EQ(theory["collisions_per_time"]["needles-ghosts"], 0);
}

TEST_F(MixedCommand, IsAuditedAndRead) {
  EXPECT_EQ(run("audit mixed.toml").exit_code, 0);
  const json done = json_of("run mixed.toml --out run.h5 --json");
  EXPECT_EQ(done["effects"], "elastic mixture passing rods");
  EXPECT_EQ(done["collisions_by_pair"]["ghosts-ghosts"], 0);
  EXPECT_EQ(run("import run.h5 --out again").exit_code, 0);
  const Composition composition = read_scene(path("again/scene.toml")).composition();
  EXPECT_EQ(composition[0].diameter, 0);
  EXPECT_EQ(composition[2].diameter, 1);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b)
      EXPECT_EQ(composition.meets(a, b), a == 2 || b == 2 || a + b == 0);
  }
  for (const char* file : {"run.xyz", "run.dump", "run.pvd"})
    EXPECT_EQ(run(std::string("export run.h5 ") + file).exit_code, 0) << file;
  EXPECT_EQ(run("import run.dump --out dump").exit_code, 0);
  EXPECT_EQ(run("view run.h5 --out run.png").exit_code, 0);
  EXPECT_EQ(run("report run.h5 -o run.html").exit_code, 0);
  EXPECT_TRUE(run("export run.h5 run.xml").exit_code != 0);
}

TEST_F(MixedCommand, RefusesARunWithoutAnEnd) {
  write("alone.toml",
        "needles.box = 7\nuntil.collisions_per_needle = 4\n"
        "[[species]]\nname = \"ghosts\"\ncount = 150\n"
        "[[pairs]]\nbetween = [\"ghosts\", \"ghosts\"]\nmeet = false\n");
  EXPECT_NE(run("run alone.toml").err.find("all needles pass through each other"),
            std::string::npos);
  EXPECT_EQ(run("run alone.toml --set until.time=10 --quiet").exit_code, 0);
}

}  // namespace
}  // namespace needlework
