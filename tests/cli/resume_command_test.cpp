// `needlework resume`: a run that was stopped goes on as if it had not been, and what cannot go on
// says why.
#include <filesystem>
#include <thread>

#include "tests/cli/program.h"

namespace needlework {
namespace {

class ResumeCommand : public ProgramTest {
 protected:
  ResumeCommand() {
    write("gas.toml", R"(
needles = { count = 300, box = 7 }
collisions = { epsilon = 0.9, tc_relative = 1e-3 }
until = { collisions_per_needle = 40 }
output = { frames = 2, events = true, observables = ["displacement", "collision_statistics"] }
)");
  }

  std::string whole_hash() const { return hash_of("run gas.toml --out whole.h5"); }
};

TEST_F(ResumeCommand, GoesOnToAnotherEnd) {
  const std::string whole = whole_hash();
  const std::string half = hash_of("run gas.toml --out a.h5 --set until.collisions_per_needle=15");
  EXPECT_NE(half, whole);
  EXPECT_EQ(hash_of("resume a.h5"), half);  // its end is already met
  EXPECT_EQ(hash_of("resume a.h5 --set until.collisions_per_needle=40 --threads 2"), whole);
  const Outcome back = run("resume a.h5 --set until.collisions_per_needle=20 --json --quiet");
  EXPECT_EQ(back.json()["collisions"], 40 * 300 / 2) << "a run does not go backwards";
}

TEST_F(ResumeCommand, CountsTheCostOfItsOwnCollisions) {
  hash_of("run gas.toml --out a.h5 --set until.collisions_per_needle=39");
  const std::string none = run("resume a.h5").out;
  EXPECT_TRUE(contains(none, "of wall time\n"));
  const auto some = run("resume a.h5 --json --quiet --set until.collisions_per_needle=40").json();
  EXPECT_EQ(some["collisions"], 40 * 300 / 2);
  const double own = some["wall_s"].get<double>() * some["collisions_per_s"].get<double>();
  EXPECT_NEAR(own, 150, 1);
  EXPECT_NEAR(some["us_per_collision"].get<double>() * own, 1e6 * some["cpu_s"].get<double>(), 1);
}

TEST_F(ResumeCommand, SaysThatTheEndIsMetAlready) {
  hash_of("run gas.toml --out a.h5 --set until.collisions_per_needle=15");
  EXPECT_TRUE(run("resume a.h5 --quiet")
                  .fails(0, "warning: the end of the run is met already: nothing to do; --set "));
  EXPECT_EQ(run("resume a.h5 --quiet --set until.collisions_per_needle=16").err, "");
  EXPECT_EQ(run("run gas.toml --quiet --out b.h5 --set until.time=0").err, "");
}

TEST_F(ResumeCommand, RemovesAnEnd) {
  const std::string whole = whole_hash();
  hash_of("run gas.toml --out a.h5 --set until.time=0.5");
  EXPECT_EQ(hash_of("resume a.h5 --set until.time=none"), whole);
  const Outcome none = run("resume a.h5 --set until.collisions_per_needle=none");
  EXPECT_TRUE(none.fails(3, "a.h5: the run has no end: expected --set until.KEY=VALUE"));
  EXPECT_TRUE(run("resume a.h5 --set until.time=never").complains("or none to remove it"));
}

class ResumeAfterASignal : public ResumeCommand, public testing::WithParamInterface<const char*> {};

TEST_P(ResumeAfterASignal, GoesOn) {
  write("long.toml", read("gas.toml") + "[engine]\nsearch = \"linked-lists\"\n");
  const std::string more = " --set needles.count=2000 --set needles.box=13 ";
  const std::string whole = hash_of("run long.toml --out whole.h5" + more);
  const std::string name = GetParam(), signal = name.substr(0, name.find("_long")),
                    file = signal + ".h5";
  const Outcome stopped = run_and_signal("run long.toml --quiet --out " + file + more,
                                         "test -e " + file + ".checkpoint", signal);
  ASSERT_EQ(stopped.exit_code, 75) << stopped.err;
  EXPECT_TRUE(contains(stopped.err, "needlework resume " + file + " continues"));
  EXPECT_EQ(hash_of("resume " + file), whole);
}

INSTANTIATE_TEST_SUITE_P(Signals, ResumeAfterASignal,
                         testing::Values("INT", "TERM_long", "HUP_long"),
                         [](const auto& signal) { return std::string(signal.param); });

TEST_F(ResumeCommand, GoesOnAfterTheTimeLimitWhichCountsAnew) {
  const Outcome stopped = run("run gas.toml --quiet --out a.h5 --set until.wall_s=0");
  EXPECT_EQ(stopped.exit_code, 75) << stopped.err;
  EXPECT_EQ(run("resume a.h5 --quiet").exit_code, 75) << "the limit holds for each process";
  EXPECT_EQ(hash_of("resume a.h5 --set until.wall_s=1e6"), whole_hash());
}

TEST_F(ResumeCommand, FollowsAFileThatWasMoved) {
  hash_of("run gas.toml --out a.h5 --set until.collisions_per_needle=15");
  std::filesystem::create_directory(path("folder"));
  for (const char* ending : {"", ".checkpoint", ".checkpoint.old"}) {
    std::filesystem::rename(path("a.h5") + ending, path("folder/b.h5") + ending);
  }
  EXPECT_EQ(hash_of("resume folder/b.h5 --set until.collisions_per_needle=40"), whole_hash());
  EXPECT_FALSE(exists("a.h5"));
}

TEST_F(ResumeCommand, FindsCheckpointsByALinkAndByTheFileItLeadsTo) {
  const std::string whole = whole_hash();
  std::filesystem::create_directory(path("folder"));
  hash_of("run gas.toml --out folder/a.h5 --set until.collisions_per_needle=15");
  std::filesystem::create_symlink("folder/a.h5", path("link.h5"));
  EXPECT_NE(hash_of("resume link.h5 --set until.collisions_per_needle=25"), whole);
  EXPECT_EQ(hash_of("resume folder/a.h5 --set until.collisions_per_needle=40"), whole);
  EXPECT_FALSE(exists("link.h5.checkpoint"));
  // A run that replaces the file through the link saves there, too.
  hash_of("run gas.toml --out link.h5 --force --set until.collisions_per_needle=15");
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.h5")));
  EXPECT_FALSE(exists("link.h5.checkpoint"));
  EXPECT_EQ(hash_of("resume folder/a.h5 --set until.collisions_per_needle=40"), whole);
  EXPECT_TRUE(run("run gas.toml --out link.h5").complains("can be continued"));
}

// A title has to be printable, the name of a file need not be.
TEST_F(ResumeCommand, TakesFilesOfAnyName) {
  const std::string whole = whole_hash();
  for (const char* name : {"'two\nlines.h5'", "'latin-1 \xe4.h5'", "'turned \u202e.h5'"}) {
    hash_of(std::string("run gas.toml --set until.collisions_per_needle=15 --out ") + name);
    EXPECT_EQ(hash_of(std::string("resume --set until.collisions_per_needle=40 ") + name), whole);
  }
}

TEST_F(ResumeCommand, TakesSpeciesThatAFileCounts) {
  hash_of("run gas.toml --out first.h5 --set until.collisions_per_needle=1");
  write("species.toml", R"(initial.file = "first.h5"
until.collisions_per_needle = 5
species = [{ name = "rods" }]
)");
  const std::string whole = hash_of("run species.toml --out whole.h5");
  hash_of("run species.toml --out a.h5 --set until.collisions_per_needle=2");
  EXPECT_EQ(hash_of("resume a.h5 --set until.collisions_per_needle=5"), whole);
}

TEST_F(ResumeCommand, EndsAtTheSameFailureAgain) {
  const std::string collapse =
      "run gas.toml --quiet --out a.h5 --set collisions.epsilon=0.3 --set collisions.tc=1e-300 "
      "--set until.collisions_per_needle=1000";
  const Outcome failed = run(collapse);
  ASSERT_EQ(failed.exit_code, 4) << failed.err;
  const Outcome again = run("resume a.h5 --quiet");
  EXPECT_EQ(again.exit_code, 4);
  EXPECT_EQ(again.err, failed.err);
}

TEST_F(ResumeCommand, RefusesOtherKeysThanEnds) {
  hash_of("run gas.toml --out a.h5");
  EXPECT_TRUE(run("resume a.h5 --set collisions.epsilon=0.5")
                  .complains("--set collisions.epsilon=0.5: expected a key of [until]"));
  EXPECT_TRUE(run("resume a.h5 --set until.tiem=3").complains("did you mean time?"));
  EXPECT_TRUE(run("resume a.h5 --set until.time=-3").complains("expected a time >= 0"));
  EXPECT_TRUE(run("resume a.h5 --isa neon").complains("--isa neon"));
  EXPECT_EQ(run("resume a.h5 --set until.tiem=3").exit_code, 3);
}

TEST_F(ResumeCommand, SaysThatThereIsNothingToContinue) {
  const Outcome missing = run("resume none.h5");
  EXPECT_EQ(missing.exit_code, 5);
  EXPECT_EQ(missing.err, "needlework: none.h5: cannot be read: No such file or directory\n");
  hash_of("run gas.toml --out a.h5 --set output.checkpoint_every=0");
  EXPECT_FALSE(exists("a.h5.checkpoint"));
  EXPECT_TRUE(run("resume a.h5").complains("there is nothing to continue\n"));
  hash_of("run gas.toml --out b.h5");
  EXPECT_TRUE(run("resume b.h5.checkpoint").complains("; expected the file of the run, b.h5\n"));
}

// A checkpoint and a file that do not belong together.
TEST_F(ResumeCommand, RefusesTheFileOfAnotherRun) {
  hash_of("run gas.toml --out a.h5");
  hash_of("run gas.toml --out b.h5 --set needles.count=200");
  std::filesystem::copy_file(path("a.h5.checkpoint"), path("b.h5.checkpoint"),
                             std::filesystem::copy_options::overwrite_existing);
  const std::string before = read("b.h5");
  EXPECT_TRUE(run("resume b.h5").fails(3, "b.h5"));
  EXPECT_TRUE(read("b.h5") == before);
}

TEST_F(ResumeCommand, NeedsTheOutputFile) {
  hash_of("run gas.toml --out a.h5");
  std::filesystem::remove(path("a.h5"));
  EXPECT_TRUE(run("resume a.h5").fails(5, "a.h5"));
}

TEST_F(ResumeCommand, IsNamedWhereAFileIsKept) {
  hash_of("run gas.toml --out a.h5");
  EXPECT_TRUE(run("run gas.toml --out a.h5").complains("can be continued by needlework resume"));
  // A new run takes the old checkpoints away.
  hash_of("run gas.toml --out a.h5 --force --set output.checkpoint_every=0");
  EXPECT_FALSE(exists("a.h5.checkpoint") || exists("a.h5.checkpoint.old"));
}

// What checkpoints cannot be written to is noticed before the run goes on.
TEST_F(ResumeCommand, NeedsAFolderThatCanBeWritten) {
  hash_of("run gas.toml --out a.h5 --set until.collisions_per_needle=15");
  std::filesystem::create_directory(path("a.h5.checkpoint.part"));
  const std::string before = read("a.h5");
  EXPECT_TRUE(
      run("resume a.h5 --set until.collisions_per_needle=16").fails(5, "a.h5.checkpoint.part: "));
  EXPECT_TRUE(read("a.h5") == before);
}

TEST_F(ResumeCommand, IsNotReplacedWhileAnotherProgramWritesIt) {
  write("second", "test -e a.h5.checkpoint || exit 1\n\"" NEEDLEWORK_PROGRAM
                  "\" run gas.toml --force --quiet --out a.h5 2>refused; echo $? >code\n");
  const Outcome first = run_and_signal(
      "run gas.toml --quiet --out a.h5 --set until.collisions_per_needle=1e9", "sh second", "INT");
  EXPECT_EQ(first.exit_code, 75) << first.err;
  EXPECT_EQ(read("code"), "5\n");
  EXPECT_EQ(
      read("refused"),
      "needlework: --out a.h5: cannot be replaced: another program or simulation has the file "
      "open for writing\n");
  hash_of("run gas.toml --force --out a.h5");
}

// The limit stands for a full disk; without the signal, writing fails.
TEST_F(ResumeCommand, GoesOnWhenThereIsRoomAgain) {
  const std::string whole = whole_hash();
  const Outcome full = shell("trap '' XFSZ; ulimit -f 1200; exec \"" NEEDLEWORK_PROGRAM
                             "\" run gas.toml --quiet --out a.h5");
  ASSERT_EQ(full.exit_code, 5) << full.err;
  EXPECT_TRUE(full.complains("a.h5"));
  EXPECT_EQ(run("info a.h5").exit_code, 0);
  EXPECT_EQ(hash_of("resume a.h5"), whole);
}

// One needle, which nothing stops, crosses more than 2^31 boxes.
TEST_F(ResumeCommand, ContinuesToAnEarlierEndWhereTooManyBoxesAreCrossed) {
  write("far.toml",
        "needles = { count = 1, box = 3 }\nuntil.time = 1e12\noutput.series_per_decade = 1\n"
        "engine.search = 'all-pairs'\n");
  EXPECT_TRUE(run("run far.toml --quiet")
                  .fails(4, "needle 0 crosses more than 2147481599 boxes along one axis"));
  const Outcome with_file = run("run far.toml --quiet --out far.h5");
  EXPECT_EQ(with_file.exit_code, 4);
  EXPECT_EQ(run("info far.h5").exit_code, 0);
  EXPECT_EQ(json_of("resume far.h5 --quiet --json --set until.time=1.5e9")["time"], 1.5e9);
}

// Whose numbers follow from those of the file, and are saved once more.
TEST_F(ResumeCommand, GoesOnFromBodiesOfAFile) {
  const std::string head = "needles = { box = 6, seed = 2 }\nuntil.time = 0.5\n";
  const std::string species = "[[species]]\nname = 'a'\ncount = 12\n", spheres = "length = 0\n";
  const std::string drawn = " = { distribution = 'uniform', mean = 0.5, width = 0.2 }\n";
  const std::string piston =
      "walls = [{ axis = 'x', side = 'high', motion = { velocity = -0.1, stop_at = 5.96 } },\n"
      "{ axis = 'x', side = 'low' }]\n";
  struct Case {
    std::string effects, bodies;
  };
  for (const auto& [effects, bodies] :
       {Case{"", species + "k" + drawn}, Case{"", species + "diameter" + drawn},
        Case{"collisions.beta = 0.5\n", species + spheres + "diameter" + drawn},
        Case{"", species + "[[species]]\nname = 'f'\ncount = 9\nfixed = true\nlength" + drawn},
        Case{"", species + "[[species]]\nname = 'f'\ncount = 9\nfixed = true\n" +
                     "diameter.aspect = 4\nlength" + drawn},
        Case{"collisions.beta = 0.5\n", species + spheres + "diameter = 1\n" +
                                            "[[species]]\nname = 'f'\ncount = 9\nfixed = true\n" +
                                            "overlap = true\nlength = 0\ndiameter" + drawn},
        Case{"driving.growth = { rate = 0.1, until_packing = 0.3 }\n",
             species + "diameter = 0.1\nlength" + drawn},
        Case{piston, species}}) {
    SCOPED_TRACE(effects + bodies);
    write("first.toml", head + effects + bodies);
    ASSERT_EQ(run("run first.toml --force --quiet --out first.h5").exit_code, 0);
    const Outcome next = run("resume first.h5 --quiet --set until.time=0.6");
    EXPECT_EQ(next.exit_code, 0) << next.err;
    write("next.toml", "initial.file = 'first.h5'\nuntil.time = 1\n" + effects);
    const std::string whole = hash_of("run next.toml --force --out whole.h5");
    hash_of("run next.toml --force --out half.h5 --set until.time=0.5");
    EXPECT_EQ(hash_of("resume half.h5 --set until.time=1"), whole);
  }
}

TEST_F(ResumeCommand, GoesOnWithoutBodiesThatMove) {
  const std::string head = "needles.box = 6\nuntil.time = 0.5\n[[species]]\nname = 'a'\ncount = ";
  write("kicked.toml", head + "0\n[driving.kicks]\nevery = 0.1\ntranslational = 1\n");
  write("still.toml", head + "0\n[[species]]\nname = 'f'\ncount = 2\nfixed = true\n");
  write("drawn.toml", head +
                          "2\n[[species]]\nname = 'b'\ncount = 0\nlength = 0\n"
                          "diameter = { distribution = 'uniform', mean = 1, width = 0.1 }\n");
  for (const std::string name : {"kicked", "still", "drawn"}) {
    const Outcome first = run("run " + name + ".toml --quiet --out " + name + ".h5");
    EXPECT_EQ(first.exit_code, 0) << first.err;
    const Outcome next = run("resume " + name + ".h5 --quiet --set until.time=1");
    EXPECT_EQ(next.exit_code, 0) << next.err;
  }
  write("grown.toml", head + "0\nlength = 0\ndiameter = 1\n[driving.growth]\nrate = 0.1\n");
  EXPECT_TRUE(run("run grown.toml").fails(3, "driving.growth.rate = 0.1: expected bodies that"));
}

// Its flight has been one since the start: searching it again took memory without limit.
TEST_F(ResumeCommand, OfOneNeedleTakesNoMoreMemoryThanItsRun) {
  write("one.toml", "needles = {count = 1, box = 3}\nuntil.time = 1e6\n");
  ASSERT_EQ(run("run one.toml --quiet --out one.h5").exit_code, 0);
  const Outcome resumed = shell(std::string("ulimit -v 4000000; '") + NEEDLEWORK_PROGRAM +
                                "' resume one.h5 --json --quiet --set until.time=2e6 --threads 1");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(resumed.json()["time"], 2e6);
}

}  // namespace
}  // namespace needlework
