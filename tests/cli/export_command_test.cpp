// What `needlework export` does with files; tests/io/open_with_*.py read what it writes.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "needlework/h5md.h"
#include "needlework/parse.h"
#include "src/io/contents.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

class ExportCommand : public ProgramTest {
 protected:
  // Runs a scene of needles of length 1.5 that writes frames at three times to a.h5.
  void make_frames(const std::string& count = "20") const {
    write("frames.toml",
          "needles.box = 7\nuntil.time = 2\noutput = { file = \"a.h5\", frames = [1], "
          "checkpoint_every = 0 }\n"
          "collisions.epsilon = 0.5\ncollisions.tc = 1e-3\n"
          "[[species]]\nname = \"a\"\nlength = 1.5\nmass = 3\nk = 2.3\ncount = " +
              count);
    ASSERT_EQ(run("run frames.toml --quiet --force").exit_code, 0);
  }
  State frame(const std::string& name, std::size_t number) const {
    return io::FrameFile(path(name)).read(number);
  }
};

TEST_F(ExportCommand, KeepsAnExistingFileUnlessForced) {
  ASSERT_EQ(run("run small.toml --quiet --out a.h5 --set output.checkpoint_every=0").exit_code, 0);
  const std::string before = read("a.h5");
  const Outcome exported = run("export a.h5 a.vtkhdf");
  EXPECT_EQ(exported.exit_code, 0);
  EXPECT_EQ(exported.out + exported.err, "");
  EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "a.vtkhdf", small}));

  EXPECT_TRUE(
      run("export a.h5 a.h5").fails(5, "a.h5: exists already: expected a new file, or --force"));
  EXPECT_EQ(read("a.h5"), before);
  EXPECT_EQ(run("export a.h5 a.vtkhdf --force").exit_code, 0);
}

TEST_F(ExportCommand, WritesNothingAfterAnError) {
  write("text.h5", "text");
  for (const auto& [arguments, message] :
       {std::pair{"absent.h5 a.vtkhdf", "absent.h5: No such file"},
        {"text.h5 a.vtkhdf", "text.h5: not an HDF5 file"},
        {"text.h5 a.pvd", "text.h5: not an HDF5 file"},
        {"text.h5 x/a.vtkhdf", "x/a.vtkhdf: cannot be written: expected a folder that exists"}}) {
    EXPECT_TRUE(run(std::string("export ") + arguments).fails(5, message)) << arguments;
  }
  EXPECT_EQ(run("export text.h5").exit_code, 2);
  EXPECT_EQ(files(), (std::vector<std::string>{small, "text.h5"}));
}

TEST_F(ExportCommand, WritesTheFrameThatIsAskedFor) {
  make_frames();
  for (const char* name : {"a.xml", "a.xml.bz2", "a.xyz", "a.data", "a.dump"}) {
    std::size_t number = 0;
    for (const char* choice : {"first", "1", "last"}) {
      ASSERT_EQ(run(fmt::format("export a.h5 {} --frame {} --force", name, choice)).exit_code, 0);
      ASSERT_EQ(run(fmt::format("import {} --out b --force", name)).exit_code, 0) << name;
      const State wanted = frame("a.h5", number++), found = frame("b/state.h5", 0);
      EXPECT_EQ(found.position, wanted.position) << name << " " << choice;
      EXPECT_EQ(found.velocity, wanted.velocity);
      EXPECT_EQ(found.orientation, wanted.orientation);
      EXPECT_EQ(found.angular_velocity, wanted.angular_velocity);
      EXPECT_EQ(found.box, wanted.box);
      EXPECT_EQ(found.id, wanted.id);
    }
  }
}

// Positions count from where the low wall is, so that a run between walls there goes on as from the
// file itself.
TEST_F(ExportCommand, CountsFromTheLowEdgeThatAPistonHasMoved) {
  write("piston.toml", R"(needles = { count = 60, box = [4, 4, 6] }
until.time = 2
output = { file = "a.h5", checkpoint_every = 0 }
[[walls]]
axis = "z"
side = "low"
motion = { velocity = 0.7 }
[[walls]]
axis = "z"
side = "high"
)");
  ASSERT_EQ(run("run piston.toml --quiet").exit_code, 0);
  const State moved = io::read_last_frame(path("a.h5"));
  ASSERT_NEAR(moved.low[2], 1.4, 1e-12);
  ASSERT_NEAR(moved.box[2], 4.6, 1e-12);
  write("from.toml",
        "initial.file = \"a.h5\"\nuntil.time = 2\nwalls = [{ axis = \"z\", side = \"both\" }]\n");
  const std::string hash = hash_of("run from.toml");
  for (const char* name : {"a.xyz", "a.data", "a.dump", "a.xml"}) {
    // DynamO is given walls at rest alone.
    const bool dynamo = std::string_view(name).ends_with("xml");
    const std::string from = dynamo ? "b.h5" : "a.h5";
    if (dynamo) {
      ASSERT_EQ(run("run from.toml --quiet --set until.time=0 --out b.h5").exit_code, 0);
    }
    ASSERT_EQ(run(fmt::format("export {} {} --frame last", from, name)).exit_code, 0) << name;
    ASSERT_EQ(run(fmt::format("import {} --out c --force", name)).exit_code, 0) << name;
    const State found = io::read_last_frame(path("c/state.h5"));
    EXPECT_EQ(found.box, moved.box) << name;
    EXPECT_EQ(found.low, (std::array<double, 3>{})) << name;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_GE(found.position[i][2], 0) << name;
      EXPECT_LE(found.position[i][2], found.box[2]) << name;
    }
    if (dynamo) continue;  // it moves the origin to the middle of the box, which rounds
    EXPECT_EQ(hash_of("run c/scene.toml --set until.time=2 --set until.collisions_per_needle=1e9"),
              hash)
        << name;
  }
}

// Also in a file without needles, where nothing is but what all would have.
TEST_F(ExportCommand, ImportOfAnExportHasTheSameSpecies) {
  for (const char* count : {"0", "20"}) {
    make_frames(count);
    for (const char* name : {"a.xml", "a.xyz", "a.data"}) {
      ASSERT_EQ(run(fmt::format("export a.h5 {} --force", name)).exit_code, 0);
      const Outcome imported = run(fmt::format("import {} --out b --force", name));
      EXPECT_EQ(imported.exit_code, 0);
      EXPECT_EQ(imported.out + imported.err, "");
      EXPECT_TRUE(
          contains(read("b/scene.toml"), {fmt::format("count = {}\n", count), "length = 1.5\n",
                                          "mass = 3\n", "k = 2.3\n", "epsilon = 0.5\n"}))
          << name;
      EXPECT_EQ(run("run b/scene.toml --quiet --set until.time=0.1 --set collisions.tc=1e-3").err,
                "");
    }
  }
  ASSERT_EQ(run("export a.h5 a.dump").exit_code, 0);
  const Outcome dump = run("import a.dump --out c");
  EXPECT_EQ(dump.err,
            "needlework: warning: a.dump: k is not in the file: 6 is assumed\n"
            "needlework: warning: a.dump: epsilon is not in the file: 1 is assumed\n");
}

TEST_F(ExportCommand, MixturesComeBackWithTheirSpeciesAndRules) {
  write("mixture.toml",
        "needles.box = 9\nuntil.time = 0.5\ncollisions = { epsilon = 0.9, tc = 1e-3 }\n"
        "[[species]]\nname = \"short, thin\"\ncount = 20\nlength = 0.5\nmass = 3\nk = 2.5\n"
        "[[species]]\nname = \"long\"\ncount = 10\nlength = 2\n"
        "[[pairs]]\nbetween = [\"long\", \"short, thin\"]\nepsilon = 0.7\nbeta = 0.5\n");
  ASSERT_EQ(run("run mixture.toml --quiet --out a.h5").exit_code, 0);
  const State wanted = io::read_last_frame(path("a.h5"));
  for (const char* name : {"a.xyz", "a.data", "a.dump"}) {
    ASSERT_EQ(run(fmt::format("export a.h5 {}", name)).exit_code, 0) << name;
    const Outcome imported = run(fmt::format("import {} --out {}-folder", name, name));
    EXPECT_EQ(imported.exit_code, 0) << imported.err;
    const std::string scene_file = fmt::format("{}-folder/scene.toml", name);
    const Scene scene = read_scene(path(scene_file));
    ASSERT_EQ(scene.species.size(), 2u) << name;
    const bool dump = name == std::string("a.dump");  // which has no names and rules
    EXPECT_EQ(scene.species[0].name, dump ? "needles 1" : "short, thin");
    EXPECT_EQ(scene.species[0].count, 20u);
    EXPECT_EQ(scene.species[0].length, 0.5);
    EXPECT_EQ(scene.species[0].mass, 3);
    EXPECT_EQ(scene.species[0].k, 2.5);
    EXPECT_EQ(scene.species[1].length, 2);
    EXPECT_EQ(scene.composition().restitution(0, 0).epsilon, dump ? 1 : 0.9);
    EXPECT_EQ(scene.composition().restitution(0, 1).epsilon, dump ? 1 : 0.7);
    EXPECT_EQ(scene.composition().restitution(0, 1).beta, dump ? -1 : 0.5);
    const State found = frame(fmt::format("{}-folder/state.h5", name), 0);
    EXPECT_EQ(found.species, wanted.species);
    EXPECT_EQ(found.position, wanted.position);
    EXPECT_EQ(run("run " + scene_file + " --quiet --set until.time=0.1").exit_code, 0);
  }
  const Outcome refused = run("export a.h5 a.xml");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(refused.err,
            "needlework: a.xml: needles of length 0.5 and 2: expected one length, as lines "
            "of DynamO that meet have one length\n");
  EXPECT_FALSE(exists("a.xml"));
  for (const char* name : {"a.pvd", "a.vtkhdf"}) {
    EXPECT_EQ(run(fmt::format("export a.h5 {}", name)).exit_code, 0) << name;
  }
  const std::vector<double> points = io::Contents(path("a.vtkhdf")).numbers("/VTKHDF/Points");
  ASSERT_EQ(points.size(), 6u * 30);
  for (std::size_t i = 0; i < 30; ++i) {
    const double* end = &points[6 * i];
    EXPECT_NEAR(std::hypot(end[3] - end[0], end[4] - end[1], end[5] - end[2]), i < 20 ? 0.5 : 2,
                1e-12);
  }
}

TEST_F(ExportCommand, DumpsOfNeedlesOfAnyLengthAreReadBack) {
  for (const char* length : {"1e-3", "0.5", "40"}) {
    write("frames.toml",
          fmt::format("needles.box = {}\nuntil.time = 0.1\noutput.file = \"{}.h5\"\n[[species]]\n"
                      "name = \"a\"\ncount = 20\nlength = {}\n",
                      7 * std::stod(length), length, length));
    ASSERT_EQ(run("run frames.toml --quiet").exit_code, 0);
    ASSERT_EQ(run(fmt::format("export {0}.h5 {0}.dump", length)).exit_code, 0);
    ASSERT_EQ(run(fmt::format("import {0}.dump --out {0}-folder", length)).exit_code, 0);
    EXPECT_EQ(run(fmt::format("run {}-folder/scene.toml --quiet", length)).exit_code, 0);
    EXPECT_EQ(frame(fmt::format("{}-folder/state.h5", length), 0).position,
              io::read_last_frame(path(fmt::format("{}.h5", length))).position);
  }
}

TEST_F(ExportCommand, WritesAllFramesWhereTheFormatHoldsThem) {
  make_frames();
  const auto count = [&](const std::string& name, const std::string& word) {
    const std::string text = read(name);
    int found = 0;
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(run("export a.h5 a.xyz").exit_code, 0);
  EXPECT_EQ(count("a.xyz", "Lattice"), 3);
  EXPECT_EQ(
      run("export a.h5 a.txt --to lammps --frame all").err,
      "needlework: warning: OUT a.txt: will be a dump of LAMMPS nevertheless: expected a name "
      "that ends in .dump\n");
  EXPECT_EQ(count("a.txt", "ITEM: TIMESTEP"), 3);
  EXPECT_EQ(run("export a.h5 a.pvd").exit_code, 0);
  EXPECT_EQ(count("a.pvd", "a/frame-"), 3);
  EXPECT_TRUE(exists("a/frame-00002.vtu"));
}

TEST_F(ExportCommand, SaysWhichFramesAndFormatsThereAre) {
  make_frames();
  for (const auto& [arguments, exit_code, message] :
       {std::tuple{"a.vtkhdf --frame all", 2,
                   "--frame all: a VTKHDF file holds one frame: expected"},
        {"a.xml --frame all", 2,
         "--frame all: a configuration of DynamO holds one frame: expected"},
        {"a.txt", 2,
         "OUT a.txt: expected a name that ends in .vtkhdf, .pvd, .xyz, .data, .dump, .xm"},
        {"a.xyz --frame 3", 3, "--frame 3: expected a number from 0 to 2, as there are 3 frames"},
        {"a.xyz --frame -1", 2, "--frame -1: expected a number from 0, first, last or all"},
        {"a.xyz --frame middle", 2, "--frame middle: expected a number from 0, first, last or all"},
        {"a.xyz --to abc", 2, "--to abc: expected one of vtkhdf, pvd, xyz, lammps, dynamo"}}) {
    EXPECT_TRUE(run(std::string("export a.h5 ") + arguments).fails(exit_code, message))
        << arguments;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "frames.toml", small}));
}

TEST_F(ExportCommand, WarnsOfWhatDynamoDoesNotHave) {
  ASSERT_EQ(run("run small.toml --quiet --out a.h5 --set collisions.beta=0.5").exit_code, 0);
  EXPECT_TRUE(
      run("export a.h5 a.xml").complains("beta = 0.5 is left out: lines of DynamO are smooth"));
  write("mixture.toml",
        "needles.box = 7\nuntil.time = 0.1\n[[species]]\nname = \"a\"\ncount = 5\nlength = 1\n"
        "[[species]]\nname = \"b\"\ncount = 5\nlength = 1\n[[pairs]]\nbetween = [\"a\", \"b\"]\n"
        "beta = 0.25\n");
  ASSERT_EQ(run("run mixture.toml --quiet --out b.h5").exit_code, 0);
  EXPECT_TRUE(
      run("export b.h5 b.xml").complains("beta = 0.25 is left out: lines of DynamO are smooth"));
}

TEST_F(ExportCommand, WarnsOfWallsThatMoveOrAreThermal) {
  write("walls.toml", R"(needles = { count = 20, box = 5 }
until.time = 0.1
output.checkpoint_every = 0
walls = [
  { axis = "z", side = "low", motion = { amplitude = 0.1, frequency = 2, phase = 0 } },
  { axis = "z", side = "high", motion = { velocity = 0 } },
  { axis = "x", side = "both", temperature = 2 },
  { axis = "y", side = "both", temperature = 2, motion = { tangential = [0, 0.1] } },
]
)");
  ASSERT_EQ(run("run walls.toml --quiet --out a.h5").exit_code, 0);
  for (const char* name : {"a.xyz", "a.data", "a.dump", "a.pvd", "a.vtkhdf"}) {
    const Outcome exported = run(fmt::format("export a.h5 {}", name));
    EXPECT_EQ(exported.exit_code, 0) << exported.err;
    for (const char* part :
         {"a.h5: walls.motion of z-low, y-low, y-high is left out: ",
          "a.h5: walls.temperature of x-low, x-high, y-low, y-high is left out: "})
      EXPECT_TRUE(contains(exported.err, part)) << name << ": " << exported.err;
  }
  write("thermal.toml",
        "needles = { count = 20, box = 5 }\nuntil.time = 0.1\noutput.checkpoint_every = 0\n"
        "walls = [{ axis = \"z\", side = \"both\", temperature = 2 }]\n");
  ASSERT_EQ(run("run thermal.toml --quiet --out b.h5").exit_code, 0);
  EXPECT_FALSE(contains(run("export b.h5 b.xml").err, "temperature"));
}

TEST_F(ExportCommand, WarnsOfTheRotationOfSpheresThatDynamoDoesNotHave) {
  write("spheres.toml",
        "needles.box = 7\nuntil.time = 0.1\noutput.checkpoint_every = 0\n"
        "species = [{ name = \"a\", count = 5, length = 0, diameter = 1 }]\n");
  ASSERT_EQ(run("run spheres.toml --quiet --out a.h5 --set collisions.beta=0.5").exit_code, 0);
  const std::string rotation =
      "a.h5: angular velocities, moments of inertia and directors of the spheres are left out";
  EXPECT_TRUE(contains(run("export a.h5 a.xml").err, rotation));
  EXPECT_EQ(run("export a.h5 a.xyz").err, "");
  ASSERT_EQ(run("run spheres.toml --quiet --out b.h5").exit_code, 0);
  EXPECT_EQ(run("export b.h5 b.xml").err, "");
}

// The run from an exported mixture is that from the file itself.
TEST_F(ExportCommand, MixturesGoToDynamoAndBack) {
  const std::string of_lines =
      "[[species]]\nname = \"a & b\"\ncount = 20\nlength = 1.5\nmass = 3\nk = 2.5\n"
      "[[species]]\nname = \"heavy\"\ncount = 10\nlength = 1.5\n"
      "[[pairs]]\nbetween = [\"heavy\", \"a & b\"]\nepsilon = 0.7\n";
  const std::string of_spheres =
      "[[species]]\nname = \"small\"\ncount = 50\nlength = 0\ndiameter = 0.3\n"
      "[[species]]\nname = \"large\"\ncount = 20\nlength = 0\ndiameter = 1.1\nmass = 20\n"
      "[[pairs]]\nbetween = [\"large\", \"small\"]\nepsilon = 0.7\n";
  for (const std::string& species : {of_lines, of_spheres}) {
    const bool lines = species == of_lines;
    const std::string scene =
        "needles.box = 7\nuntil.collisions_per_needle = 5\n"
        "collisions = { epsilon = 0.9, tc = 1e-3 }\n";
    write("mixture.toml", scene + species);
    ASSERT_EQ(run("run mixture.toml --quiet --force --out a.h5").exit_code, 0);
    write("on.toml", scene + "initial.file = \"a.h5\"\n" + species);
    const Outcome exported = run("export a.h5 a.xml --force");
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    EXPECT_EQ(exported.err,
              lines ? "needlework: warning: a.h5: species differ in mass or moment of inertia: "
                      "DynamO takes both numbers of the first of two lines for the other one, too\n"
                    : "");
    const Outcome imported = run("import a.xml --out folder --force");
    ASSERT_EQ(imported.exit_code, 0) << imported.err;
    EXPECT_EQ(imported.err,
              lines ? "needlework: warning: a.xml: species differ in mass or moment of inertia: "
                      "DynamO takes both numbers of the first of two lines for the other one, too; "
                      "here each has its own\n"
                    : "");
    const Composition found = read_scene(path("folder/scene.toml")).composition();
    EXPECT_EQ(found[0].name, lines ? "a & b" : "small");
    EXPECT_EQ(found.restitution(0, 1).epsilon, 0.7);
    EXPECT_EQ(hash_of("run folder/scene.toml --set collisions.tc=1e-3 --set "
                      "until.collisions_per_needle=5"),
              hash_of("run on.toml"));
  }
}

}  // namespace
}  // namespace needlework
