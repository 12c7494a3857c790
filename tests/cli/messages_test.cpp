// Answers to the mistakes of newcomers: each says what was expected, or which command is meant.
#include "needlework/theory.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using Messages = ProgramTest;

struct Mistake {
  const char *arguments, *answer;
};

TEST_F(Messages, WrongUsageIsAnsweredByWhatIsMeant) {
  const std::string commands =
      "expected one of run, resume, replay, sweep, reproduce, check, theory, predict, audit, info, "
      "import, "
      "export, report, view, serve, bench, help";
  for (const Mistake& mistake : {
           Mistake{"", "expected a command, such as needlework run SCENE.toml (see "},
           {"simulate small.toml",
            "simulate: unknown command, did you mean run? (see needlework --help)"},
           {"rnu small.toml", "did you mean run?"},
           {"go small.toml", "did you mean run?"},
           {"small.toml",
            "expected a command before a file, as in needlework run small.toml (see "},
           {"state.h5", "as in needlework info state.h5 (see "},
           {"version", "did you mean --version?"},
           {"fly", "bench, help (see needlework --help)"},
           {"help fly", "fly: unknown command: expected one of run"},
           {"--json run small.toml", "--json: expected a command before its options, as in "},
           {"--verison", "--verison: unknown option, did you mean --version?"},
           {"run",
            "SCENE.toml is missing: expected needlework run [OPTIONS] SCENE.toml (see "
            "needlework run --help)"},
           {"check", "SCENE.toml is missing: expected needlework check [OPTIONS] SCENE.toml (see "},
           {"info", "(see needlework info --help)"},
           {"run small.toml --set", "(see needlework run --help)"},
           {"run small.toml --threads 0", "(see needlework run --help)"},
           {"run small.toml --outt x.h5",
            "--outt: unknown option, did you mean --out? (see "
            "needlework run --help)"},
           {"run small.toml --outt=x.h5", "--outt: unknown option, did you mean --out?"},
           {"run small.toml -o x.h5", "-o: unknown option, did you mean --out?"},
           {"run small.toml --zzz", "--zzz: unknown option: expected one of -h, --help, --set"},
           {"run small.toml needles.count=5",
            "needles.count=5: unexpected argument, did you mean --set needles.count=5?"},
           {"run small.toml --needles.count=5", "did you mean --set needles.count=5?"},
           {"run small.toml more.toml",
            "more.toml: unexpected argument: expected needlework run [OPTIONS] SCENE.toml"},
           {"run small.toml --threads", "--threads: expected N|auto after it"},
           {"run small.toml --threads two",
            "--threads two: expected a whole number from 1 to 1024 or auto"},
           {"predict pairs.csv --accuracy high",
            "--accuracy high: expected one of fast, standard, rigorous"},
           {"bench --repetitions 0", "--repetitions 0: expected a whole number from 1 to 1000"},
           {"theory --epsilon 0.8",
            "--k is missing: expected a number in [1e-12, 1e12], or a "
            "scene (see needlework theory --help)"},
           {"theory --epsilon 0.8 --k 6 --time 5",
            "--time 5: expected --density N beside it, or a scene"},
           {"theory --epsilon 0.8 --k 6 --set needles.count=5",
            "--set needles.count=5: expected a scene"},
       }) {
    EXPECT_TRUE(run(mistake.arguments).fails(2, mistake.answer)) << mistake.arguments;
  }
  EXPECT_TRUE(run("fly").complains(commands));
}

TEST_F(Messages, FilesGivenToTheWrongCommandAreNamedWithTheRightOne) {
  ASSERT_EQ(run("run small.toml --quiet --out state.h5").exit_code, 0);
  write("grid.toml", "scene = \"small.toml\"\nseeds = [1]\nout = \"out\"\n");
  write("broken.toml", "[needles]\ncount = many\n");
  write("pairs.csv", "1,a,2,0,0,0,1,0,0,0,0,0,0,0,0,1,1,1,0,1,0,0,0,0,0,0,0,0\n");
  struct Case {
    const char* arguments;
    int exit_code;
    const char* answer;
  };
  for (const Case& wrong : {
           Case{"run state.h5", 3,
                "needlework: state.h5: expected a scene (TOML); it is an HDF5 file, which "
                "needlework info state.h5 describes and initial.file = \"state.h5\" in a scene "
                "continues from"},
           {"check state.h5", 3, "expected a scene (TOML); it is an HDF5 file"},
           {"audit state.h5", 3, "expected a scene (TOML); it is an HDF5 file"},
           {"theory state.h5", 3, "expected a scene (TOML); it is an HDF5 file"},
           {"run grid.toml", 3,
            "grid.toml: line 1: scene = \"small.toml\": expected a section or title; it is the "
            "grid of a sweep (TOML), which needlework sweep grid.toml runs"},
           {"run pairs.csv", 3, "which needlework predict pairs.csv reads"},
           {"sweep small.toml --out out", 3,
            "small.toml: seeds is missing: expected a list, or {first = SEED, count = N}; it is a "
            "scene (TOML), which needlework run small.toml runs"},
           {"sweep state.h5", 3, "expected the grid of a sweep (TOML); it is an HDF5 file"},
           {"predict state.h5", 3, "expected a list of pairs of needles (CSV); it is an HDF5 file"},
           {"predict small.toml", 3, "it is a scene (TOML), which needlework run small.toml runs"},
           {"info small.toml", 5, "small.toml: not an HDF5 file; it is a scene (TOML), which "},
           {"export grid.toml a.vtkhdf", 5, "not an HDF5 file; it is the grid of a sweep (TOML)"},
           {"run broken.toml", 3, "broken.toml: line 2: "},
           {"info broken.toml", 5, "broken.toml: not an HDF5 file"},
       }) {
    EXPECT_TRUE(run(wrong.arguments).fails(wrong.exit_code, wrong.answer)) << wrong.arguments;
  }
}

TEST_F(Messages, HelpIsACommandToo) {
  EXPECT_EQ(run("help").out, run("--help").out);
  EXPECT_EQ(run("help run").out, run("run --help").out);
  EXPECT_TRUE(contains(run("help run").out, "--out FILE.h5"));
  EXPECT_EQ(run("-v").out, run("--version").out);
  EXPECT_EQ(run("help").exit_code, 0);
}

TEST_F(Messages, NamesThatHideWhatAFileIsDeserveAWarning) {
  EXPECT_TRUE(run("run small.toml --quiet --out x.txt")
                  .fails(0,
                         "warning: --out x.txt: will be an HDF5 file nevertheless: expected a name "
                         "that ends in .h5"));
  for (const std::string name : {"a.h5", "a.hdf5", "a.h5md"}) {
    EXPECT_EQ(run("run small.toml --quiet --out " + name).err, "") << name;
  }
  EXPECT_TRUE(run("export a.h5 a.vtk --to vtkhdf")
                  .complains("warning: OUT a.vtk: will be a VTKHDF file nevertheless: expected a "
                             "name that ends in .vtkhdf"));
  EXPECT_EQ(run("export a.h5 a.vtkhdf").err, "");
}

TEST_F(Messages, HeadersOfPairsThatMeanSomethingElseAreErrors) {
  const std::string pair = "1,a,2,.25,-.125,-.5,1,0,0,0,0,.75,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0\n";
  const std::string names =
      "id,family,horizon,r1x,r1y,r1z,u1x,u1y,u1z,v1x,v1y,v1z,w1x,w1y,w1z,"
      "r2x,r2y,r2z,u2x,u2y,u2z,v2x,v2y,v2z,w2x,w2y,w2z,skip\n";
  write("right.csv", names + pair);
  EXPECT_EQ(run("predict right.csv").exit_code, 0);
  std::string swapped = names;
  swapped.replace(swapped.find("u1x"), 3, "v1x");
  write("swapped.csv", swapped + pair);
  EXPECT_TRUE(
      run("predict swapped.csv").fails(3, "swapped.csv: line 1: column 7 = v1x: expected u1x"));
  write("other.csv", "name,kind,time\n" + pair);
  EXPECT_TRUE(run("predict other.csv")
                  .fails(3,
                         "other.csv: line 1: column id = name: expected 28 columns of "
                         "numbers, or the header id,family,horizon, then x,y,z of "));
}

TEST_F(Messages, SummariesSayWhichTimeIsMeant) {
  const Outcome outcome = run("run small.toml");
  EXPECT_TRUE(contains(outcome.out, {" of wall time; ", " us per collision of CPU time\n"}));
}

// Haff's law makes 1e5 collisions per needle last beyond what a double can hold.
TEST_F(Messages, CheckKnowsEndsThatAreFarAway) {
  const std::string cooling =
      "check small.toml --set collisions.epsilon=0.8 --set collisions.tc_relative=1e-3 "
      "--set until.collisions_per_needle=";
  EXPECT_TRUE(contains(run(cooling + "5000").out, "collisions_per_needle is met first, at time "));
  const Outcome far = run(cooling + "1e5");
  EXPECT_TRUE(contains(far.out, "collisions_per_needle is not met before time 1e308"));
  EXPECT_FALSE(contains(far.out, "never ends"));
  EXPECT_TRUE(run(cooling + "1e5 --json").json()["expected"]["wall_s"].is_null());
}

TEST_F(Messages, TheoryTakesTimesAndScenes) {
  const auto by_options =
      run("theory --epsilon 0.8 --k 6 --density 0.4 --time 10 --tau 3 --json").json();
  EXPECT_EQ(by_options["density"], 0.4);
  EXPECT_EQ(by_options["tau"][0], 3);
  EXPECT_DOUBLE_EQ(by_options["time"][1].get<double>(), 10);
  EXPECT_DOUBLE_EQ(by_options["tau"][1].get<double>(), 10 * 0.4 * 2 / 3 * std::sqrt(M_PI));

  const std::string scene = "theory small.toml --set collisions.epsilon=0.8 --json";
  const auto by_scene = run(scene + " --tau 3 --time 10").json();
  EXPECT_EQ(by_scene, by_options);
  EXPECT_EQ(run("theory --json --set collisions.epsilon=0.8 --time 10 --tau 3 small.toml").json(),
            by_options);
  EXPECT_EQ(run(scene + " --epsilon 0.9").json()["epsilon"], 0.9);
  const auto usual = run(scene).json();
  EXPECT_GT(usual["time"].size(), 2u);
  EXPECT_EQ(usual["energy"][0], 2.5);

  EXPECT_TRUE(contains(output_of("theory small.toml --set collisions.epsilon=0.8"),
                       {"density 0.4", "tends to c = 1.037732671", "time", "T_rot"}));
}

}  // namespace
}  // namespace needlework
