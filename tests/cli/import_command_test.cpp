// `needlework import`: the scene and the state that it writes, and what it leaves alone.
#include "needlework/h5md.h"
#include "needlework/parse.h"
#include "tests/cli/program.h"
#include "tests/io/complaints.h"
#include "tests/io/dynamo_text.h"

namespace needlework {
namespace {

using io::dynamo_text;
using io::replaced;

using ImportCommand = ProgramTest;

const std::string row_of_x = "X 1 3 3 1 0 0 1 0 0 0 1 0\n";

// A frame of extended XYZ in a cube of edge 6, with more in its comment.
std::string xyz_of(const std::string& more, const std::string& rows = row_of_x, int count = 1) {
  return std::to_string(count) +
         "\nLattice=\"6 0 0 0 6 0 0 0 6\" Properties=species:S:1:pos:R:3:velo:R:3:orientation:R:3:"
         "angular_velocity:R:3 " +
         more + "\n" + rows;
}

TEST_F(ImportCommand, MakesASceneThatRuns) {
  write("lines.xml", dynamo_text);
  const Outcome imported = run("import lines.xml --out a/b");
  EXPECT_EQ(imported.exit_code, 0);
  EXPECT_EQ(imported.out + imported.err, "");
  const Scene scene = read_scene(path("a/b/scene.toml"));
  ASSERT_EQ(scene.species.size(), 1u);
  EXPECT_EQ(scene.species[0].name, "Bulk");
  EXPECT_EQ(scene.species[0].count, 2u);
  EXPECT_EQ(scene.species[0].length, 2);
  EXPECT_EQ(scene.species[0].mass, 2);
  EXPECT_EQ(scene.species[0].k, 6);
  EXPECT_EQ(scene.collisions.epsilon, 0.9);
  EXPECT_EQ(scene.needles.box, (std::array<double, 3>{8, 9, 10.5}));
  const State state = io::read_last_frame(path("a/b/state.h5"));
  EXPECT_EQ(state.position[0][0], -3.9);
  EXPECT_EQ(state.box, scene.needles.box);
  // From any folder, because the scene names its state by the full path.
  EXPECT_EQ(shell("cd a && " NEEDLEWORK_PROGRAM " run b/scene.toml --quiet").exit_code, 0);
}

// Of which the one species is said, and the other homogeneous by default.
TEST_F(ImportCommand, KeepsRoughSpheresThatWereExported) {
  write("s.toml",
        "needles.box = 6\ncollisions.beta = 0.5\nuntil.time = 1\n"
        "[[species]]\nname = \"a\"\ncount = 20\nlength = 0\ndiameter = 0.8\ninertia = 0.05\n"
        "[[species]]\nname = \"b\"\ncount = 20\nlength = 0\ndiameter = 0.5\n");
  ASSERT_EQ(run("run s.toml --out run.h5 --quiet").exit_code, 0);
  const State before = io::read_last_frame(path("run.h5"));
  const std::string on = " --quiet --set collisions.beta=0.5 --set until.time=1 --out ";
  for (const std::string name : {"run.xyz", "run.dump"}) {
    ASSERT_EQ(run("export run.h5 " + name).exit_code, 0);
    const Outcome imported = run("import --force --out a " + name);
    ASSERT_EQ(imported.exit_code, 0) << imported.err;
    const State state = io::read_last_frame(path("a/state.h5"));
    EXPECT_EQ(state.angular_velocity, before.angular_velocity) << name;
    const Scene scene = read_scene(path("a/scene.toml"));
    for (std::size_t n = 0; n < 2; ++n)
      EXPECT_EQ(scene.species.at(n).given_inertia.value_or(0), before.bodies.inertia.at(n));
    // So that scenes that start from the state have them, too.
    EXPECT_EQ(state.bodies.inertia, before.bodies.inertia) << name;
    const bool is_said = name == "run.xyz";
    EXPECT_EQ(scene.collisions.beta, is_said ? 0.5 : 1);
    EXPECT_NE(contains(imported.err, "beta is not in the file: 1 is assumed"), is_said);
    const Outcome ran = run("run a/scene.toml" + on + name + ".h5");
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
  }
}

TEST_F(ImportCommand, KeepsExistingFilesUnlessForced) {
  write("lines.xml", dynamo_text);
  ASSERT_EQ(run("import lines.xml --out a").exit_code, 0);
  const std::string before = read("a/state.h5");
  write("other.xml", replaced(dynamo_text, "x=\"0.3\"", "x=\"0.4\""));
  EXPECT_TRUE(run("import other.xml --out a")
                  .fails(5, "a/scene.toml: exists already: expected a new file, or --force"));
  EXPECT_EQ(read("a/state.h5"), before);
  EXPECT_EQ(run("import other.xml --out a --force").exit_code, 0);
  EXPECT_NE(read("a/state.h5"), before);
}

TEST_F(ImportCommand, WritesNothingAfterAnError) {
  write("small-box.xml", replaced(dynamo_text, "y=\"9\"", "y=\"4\""));
  write("gravity.xml", replaced(dynamo_text, "Newtonian", "Compression"));
  for (const auto& [arguments, exit_code, message] :
       {std::tuple("absent.xml --out a", 5, "absent.xml: cannot be read: No such file"),
        std::tuple("gravity.xml --out a", 3, "gravity.xml: line 28: Dynamics Type = Compression"),
        std::tuple("small-box.xml --out a", 3,
                   "small-box.xml: cannot be run: scene.toml: line 4: "),
        std::tuple("small.toml --out a", 3, "which needlework run small.toml runs"),
        std::tuple(". --out a", 5, ".: cannot be read: Is a directory"),
        std::tuple("gravity.xml", 2, "--out is missing: expected needlework import")}) {
    EXPECT_TRUE(run(std::string("import ") + arguments).fails(exit_code, message)) << arguments;
  }
  EXPECT_FALSE(exists("a"));
}

TEST_F(ImportCommand, WritesWallsAndGravity) {
  write("a.xyz",
        xyz_of("pbc=\"T T F\" length=1 mass=1 k=6 epsilon=1 walls=z-low,z-high wall_epsilon=0.5,1 "
               "gravity=0,0,-2"));
  const Outcome imported = run("import a.xyz --out a");
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_EQ(imported.err, "");
  const Scene scene = read_scene(path("a/scene.toml"));
  ASSERT_EQ(scene.wall_sides().size(), 2u);
  EXPECT_EQ(scene.walls[0].axis + scene.walls[0].side, "zlow");
  EXPECT_EQ(scene.walls[0].epsilon, 0.5);
  EXPECT_EQ(scene.forces.gravity, (std::array<double, 3>{0, 0, -2}));
  EXPECT_EQ(io::read_last_frame(path("a/state.h5")).periodic, (std::array{true, true, false}));
}

TEST_F(ImportCommand, AssumesWallsWhereABoxIsNotPeriodic) {
  const std::string text = xyz_of("pbc=\"F T T\" length=1 mass=1 k=6 epsilon=1");
  write("a.xyz", text);
  EXPECT_TRUE(run("import a.xyz --out a").fails(0, "walls at rest with epsilon = 1 are assumed"));
  const Scene scene = read_scene(path("a/scene.toml"));
  ASSERT_EQ(scene.walls.size(), 1u);
  EXPECT_EQ(scene.walls[0].axis + scene.walls[0].side, "xboth");
  write("b.xyz", replaced(text, "epsilon=1", "epsilon=1 walls=y-low,y-high"));
  EXPECT_TRUE(run("import b.xyz --out b")
                  .fails(3, "not periodic along x, with walls along others: expected walls"));
}

TEST_F(ImportCommand, WhatItAssumesMayBeSaidOtherwise) {
  write("a.xyz", xyz_of("length=1 mass=1 epsilon=1"));
  ASSERT_TRUE(run("import a.xyz --out a").complains("k is not in the file: 6 is assumed"));
  EXPECT_EQ(run("check a/scene.toml --set until.time=1 --set species.k=3").exit_code, 0);
  EXPECT_TRUE(run("check a/scene.toml --set until.time=1 --set species.length=2")
                  .fails(3, "--set species.length=2: expected 1, as in "));
}

TEST_F(ImportCommand, TellsOfBodiesThatOverlap) {
  const std::string rest = " 3 3 1 0 0 1 0 0 0 0 0\n";
  write("a.xyz", xyz_of("length=0 diameter=1 mass=1 k=6 epsilon=1",
                        "X 1" + rest + "X 1.75" + rest + "X 2.25" + rest + "X 5" + rest, 4));
  const Outcome imported = run("import a.xyz --out a");
  EXPECT_EQ(imported.exit_code, 0);
  const std::string overlaps =
      "2 pairs of rods overlap; deepest, rods 1 and 2 overlap: their axes are 0.5 apart, less than "
      "1";
  EXPECT_TRUE(imported.complains("a.xyz: cannot be run as it is: state: " + overlaps));
  EXPECT_TRUE(run("check a/scene.toml").fails(3, overlaps));
}

TEST_F(ImportCommand, TakesTheFrameThatIsAskedFor) {
  const std::string head = xyz_of("length=1 mass=1 k=6 epsilon=1", "X ");
  const std::string rest = " 3 3 1 0 0 1 0 0 0 1 0\n";
  write("a.xyz", head + "1" + rest + head + "2" + rest + head);
  EXPECT_TRUE(run("import a.xyz --out a")
                  .fails(3, "the 2 frames before it are whole: --frame 1 reads the last of them"));
  for (const auto& [frame, place] : {std::pair("1", 2.0), {"first", 1.0}}) {
    ASSERT_EQ(run("import a.xyz --force --out a --frame " + std::string(frame)).exit_code, 0);
    EXPECT_EQ(io::read_last_frame(path("a/state.h5")).position[0][0], place);
  }
  EXPECT_EQ(run("import a.xyz --out b --frame all").exit_code, 2);
}

TEST_F(ImportCommand, OtherCommandsNameIt) {
  write("lines.xml", dynamo_text);
  EXPECT_TRUE(
      run("run lines.xml")
          .complains(
              "it is a configuration of another program, which needlework import lines.xml reads"));
}

TEST_F(ImportCommand, NamesThatNeedQuotesAreKept) {
  write("lines \"a\\b\".xml",
        replaced(dynamo_text, "Name=\"Bulk\" Type", "Name=\"a&quot;b\\&#10;&#233;\" Type"));
  ASSERT_EQ(run("import 'lines \"a\\b\".xml' --out \"it's\"").exit_code, 0);
  const Scene scene = read_scene(path("it's/scene.toml"));
  EXPECT_EQ(scene.species[0].name, "a\"b\\\\né");  // the line break as \n
  EXPECT_EQ(scene.title, "Imported from lines \"a\\b\".xml");
}

// The scene names its state by its path, which has to be the one that was written.
TEST_F(ImportCommand, FoldersMayHaveAnyNameThatAFolderCanHave) {
  write("lines.xml", dynamo_text);
  for (const char* folder : {"a\nb", "a\tb", "\x1b[1m\x7f", "q\"u\\o'te", "\u00e9\u202e"}) {
    const std::string quoted = "'" + std::string(folder) + "'";
    const std::string word = folder[1] == '"' ? "\"q\\\"u\\\\o'te\"" : quoted;
    const Outcome imported = run("import lines.xml --out " + word);
    EXPECT_EQ(imported.exit_code, 0) << imported.err;
    EXPECT_EQ(run("run " + word + "/scene.toml --quiet").exit_code, 0) << folder;
  }
  EXPECT_TRUE(run("import lines.xml --out 'a\xff'")
                  .fails(5, "a\\xff: cannot be named in a scene: expected a folder whose full"));
  EXPECT_FALSE(exists("a\xff"));
}

TEST_F(ImportCommand, WarnsOfWhatRoundingHasDone) {
  write("a.xyz",
        xyz_of("length=1 mass=1 k=6 epsilon=1", "X 1 3 3 1 0 0 0.577 0.577 0.578 1 -1 0\n"));
  const Outcome imported = run("import a.xyz --out a");
  EXPECT_EQ(imported.exit_code, 0);
  EXPECT_EQ(
      imported.err,
      "needlework: warning: a.xyz: 1 of 1 needles were projected: their directors were not of "
      "length 1, or their angular velocities not normal to them, by up to 2.9e-05, as "
      "rounding does\n");
  EXPECT_EQ(run("run a/scene.toml --quiet --set until.time=1").exit_code, 0);
}

}  // namespace
}  // namespace needlework
