// Gases whose bodies differ within a species, and fixed bodies, from command to command.
#include <string>

#include "tests/cli/program.h"

namespace needlework {
namespace {

const std::string head = "needles.box = 8\nuntil.collisions_per_needle = 2\n";
const std::string needles = head +
                            "[[species]]\nname = \"a\"\ncount = 100\nmass.density = 2\n"
                            "length = { distribution = \"lognormal\", mean = 1, width = 0.3 }\n";
const std::string rods =
    head +
    "[[species]]\nname = \"rods\"\ncount = 80\nmass.density = 5\ndiameter.aspect = 4\n"
    "length = { distribution = \"lognormal\", mean = 1, width = 0.3 }\n"
    "[[species]]\nname = \"balls\"\ncount = 20\nlength = 0\n"
    "diameter = { distribution = \"uniform\", mean = 0.6, width = 0.2 }\n";
const std::string fixed =
    head +
    "[[species]]\nname = \"a\"\ncount = 100\nlength = 0\ndiameter = 0.5\n"
    "[[species]]\nname = \"walls\"\ncount = 30\nlength = 0\ndiameter = 1\nfixed = true\n"
    "overlap = true\n";

class OwnBodiesOfPrograms : public ProgramTest {
 protected:
  void run_scene(const std::string& text) const {
    write("s.toml", text);
    output_of("run s.toml --out run.h5 --force --quiet");
  }
};

// The same bodies at the same temperatures, which collide alike.
TEST_F(OwnBodiesOfPrograms, AreTheSameAfterExportAndImport) {
  for (const std::string& text : {needles, rods, fixed}) {
    run_scene(text);
    write("go_on.toml", "initial.file = \"run.h5\"\nuntil.collisions_per_needle = 2\n");
    const std::string expected = hash_of("run go_on.toml");
    const auto start = json_of("check go_on.toml --json");
    for (const char* name : {"run.xyz", "run.dump"}) {
      output_of(std::string("export run.h5 --force ") + name);
      output_of(std::string("import --out imported --force ") + name);
      EXPECT_EQ(hash_of("run imported/scene.toml --set until.collisions_per_needle=2"), expected)
          << name;
      const auto found = json_of("check imported/scene.toml --json");
      EXPECT_EQ(found["mean_free_time"], start["mean_free_time"]) << name;
    }
  }
}

TEST_F(OwnBodiesOfPrograms, AreDrawnAndListed) {
  run_scene(rods);
  const std::string listed = output_of("info run.h5");
  for (const char* name : {"    length ", "    diameter ", "    inertia "})
    EXPECT_TRUE(contains(listed, name)) << name;
  EXPECT_TRUE(contains(listed, "Length of the axis of each needle"));
  output_of("view run.h5 --out run.svg");
  EXPECT_TRUE(contains(read("run.svg"), "of lengths 0 to "));
  output_of("report run.h5 --out run.html");
  EXPECT_TRUE(contains(read("run.html"), "share_of_diameter"));
}

TEST_F(OwnBodiesOfPrograms, MayBeVariedInSweeps) {
  write("s.toml", needles);
  write("grid.toml",
        "scene = \"s.toml\"\nseeds = [1, 2]\n[parameters]\n\"species.a.length.width\" = [0.1, "
        "0.3]\n");
  output_of("sweep grid.toml --out sweep --threads 1 --quiet");
  EXPECT_TRUE(exists("sweep/a.length.width=0.3,seed=2.h5"));
}

TEST_F(OwnBodiesOfPrograms, ComeBackInAReplay) {
  write("s.toml", needles);
  EXPECT_EQ(run("run s.toml --out run.h5 --quiet --set collisions.epsilon=0.2 "
                "--set until.collisions_per_needle=500")
                .exit_code,
            4);
  EXPECT_TRUE(contains(run("replay run.h5.failure").err, "the failure came back"));
}

}  // namespace
}  // namespace needlework
