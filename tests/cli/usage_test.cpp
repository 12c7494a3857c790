// Exit codes and messages: what scripts rely on when something is wrong.
#include <algorithm>
#include <fstream>

#include "kernels/isa.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using Usage = ProgramTest;

TEST_F(Usage, HelpAndVersionExitWith0) {
  EXPECT_EQ(run("--help").exit_code, 0);
  EXPECT_EQ(run("run --help").exit_code, 0);
  EXPECT_TRUE(contains(output_of("--version"), {"needlework 1.", "compiler", "ISA       scalar",
                                                "HDF5      1.", "MPI       ", "Python    "}));
}

TEST_F(Usage, EnginesThatAreNotOnOfferExitWith3) {
  const std::pair<const char*, const char*> cases[] = {
      {"--threads 2 --set engine.queue=bucket", "--threads 2: expected 1 with search "},
      {"--threads 2 --set engine.queue=tournament", "--threads 2: expected 1 with search "},
      {"--threads 2 --set engine.search=linked-lists", "--threads 2: expected 1 with search "},
      {"--set engine.threads=2 --set engine.search=all-pairs",
       "--set engine.threads=2: expected 1 with search "},
      {"--isa bogus", "--isa bogus: expected auto or one that this CPU has (scalar"},
      {"--isa AVX2", "--isa AVX2: expected "}};
  const auto expect_refusal = [&](const std::string& arguments, const std::string& message) {
    EXPECT_TRUE(run("run small.toml " + arguments).fails(3, message)) << arguments;
  };
  for (const auto& [arguments, message] : cases) expect_refusal(arguments, message);
  const std::vector<kernels::Isa> available = kernels::available();
  for (const kernels::Isa isa : {kernels::Isa::sse4, kernels::Isa::avx2, kernels::Isa::avx512}) {
    if (std::find(available.begin(), available.end(), isa) != available.end()) continue;
    const std::string name(kernels::name_of(isa));
    expect_refusal("--isa " + name, "--isa " + name + ": expected ");
    expect_refusal("--set engine.isa=" + name, "--set engine.isa=" + name + ": expected ");
  }
}

TEST_F(Usage, WhatThisMachineLacksIsNamedWithItsLine) {
  const auto expect_refusal = [&](const std::string& scene, const std::string& message) {
    write("much.toml", scene);
    for (const char* command : {"run", "check"}) {
      EXPECT_TRUE(run(std::string(command) + " much.toml")
                      .fails(3, "needlework: much.toml: line " + message))
          << scene;
    }
  };
  expect_refusal("[needles]\nbox = 1e4\ncount = 4_000_000_000\n[until]\ntime = 1\n",
                 "3: needles.count = 4_000_000_000: expected fewer: ");
  // Before all of them are drawn.
  const std::string drawn =
      "[[species]]\nname = 'a'\nmass.density = 1\ncount = 2_000_000_000\n"
      "length = {distribution = 'gamma', mean = 1, width = 0.3}\n";
  expect_refusal("needles.box = 1e4\nuntil.time = 1\n" + drawn,
                 "6: species.count = 2_000_000_000: expected fewer: ");
  const std::string rest = "needles = {count = 5, box = 5}\nuntil.time = 1\n[engine]\n";
  expect_refusal(rest + "threads = 2\nqueue = 'bucket'\n",
                 "4: engine.threads = 2: expected 1 with search ");
}

TEST_F(Usage, RunsInWhichNothingHappensNeedAnEndTime) {
  for (const char* scene : {"--set needles.count=1", "--set needles.count=0",
                            "--set initial.t_tr=0 --set initial.t_rot=0"}) {
    const std::string arguments = std::string("run small.toml --quiet --out none.h5 ") + scene;
    const Outcome endless = run(arguments);
    EXPECT_EQ(endless.exit_code, 3) << scene;
    EXPECT_TRUE(contains(endless.err, "nothing can ever happen"));
    EXPECT_FALSE(exists("none.h5"));
  }
  const Outcome alone = run("run small.toml --json --set needles.count=1 --set until.time=7.5");
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_EQ(alone.json()["time"], 7.5);
  EXPECT_EQ(alone.json()["stop"], "time");
}

TEST_F(Usage, ElasticNeedlesNeedAnotherEndThanTheirEnergy) {
  write("kept.toml", "needles = {count = 20, box = 5}\nuntil.energy_ratio = 0.5\n");
  for (const char* scene : {"", "--set collisions.beta=1"}) {
    const Outcome endless = run(std::string("run kept.toml --quiet --out kept.h5 ") + scene);
    EXPECT_EQ(endless.exit_code, 3) << scene;
    EXPECT_TRUE(contains(endless.err,
                         "needlework: kept.toml: line 2: until.energy_ratio = 0.5: is never "
                         "met, as collisions keep the energy: expected another end"));
    EXPECT_FALSE(exists("kept.h5"));
  }
  for (const char* scene : {"--set until.collisions_per_needle=1", "--set until.wall_s=0.01",
                            "--set until.energy_ratio=1",
                            "--set collisions.epsilon=0.5 --set collisions.tc_relative=0.001"}) {
    const int exit_code = run(std::string("run kept.toml --quiet ") + scene).exit_code;
    EXPECT_TRUE(exit_code == 0 || exit_code == 75) << scene << ": " << exit_code;
  }
}

TEST_F(Usage, FilesThatCannotBeReadExitWith5) {
  for (const char* arguments : {"run absent.toml", "check absent.toml", "info absent.h5",
                                "run small.toml --set initial.file=absent.h5"}) {
    EXPECT_TRUE(run(arguments).fails(5, "absent")) << arguments;
  }
}

TEST_F(Usage, StatesThatCannotBeReadAreNamedWithTheLineThatAsksForThem) {
  write("next.toml", "[initial]\nfile = \"old.h5\"\n[until]\ntime = 1\n");
  const std::string place = "needlework: next.toml: line 2: initial.file = \"old.h5\": ";
  EXPECT_TRUE(
      run("check next.toml").fails(5, place + "cannot be read: old.h5: No such file or directory"));
  write("old.h5", "no such thing");
  EXPECT_TRUE(run("run next.toml").complains(place + "cannot be read: old.h5: not an HDF5 file"));
}

TEST_F(Usage, FilesThatCannotBeWrittenExitWith5BeforeAnyComputing) {
  write("endless.toml",
        "[needles]\ncount = 5000\nbox = 20\n[until]\ntime = 1e9\n[output]\nfile = \"x/y.h5\"\n");
  const Outcome outcome = run("run endless.toml");
  EXPECT_TRUE(outcome.fails(5,
                            "needlework: endless.toml: line 7: output.file = \"x/y.h5\": cannot be "
                            "written: expected a folder that exists, not x"));
  const Outcome checked = run("check endless.toml");
  EXPECT_EQ(checked.exit_code, 5);
  EXPECT_EQ(checked.err, outcome.err);
  EXPECT_EQ(checked.out, "");
  for (const std::string file : {".", "/dev/full", "/proc/a.h5"}) {
    EXPECT_TRUE(run("run endless.toml --force --out " + file)
                    .fails(5, "--out " + file + ": cannot be written: "))
        << file;
  }
}

TEST_F(Usage, AnExistingFileIsKeptUnlessForced) {
  write("kept.h5", "precious");
  EXPECT_TRUE(run("run small.toml --out kept.h5")
                  .fails(5, "kept.h5: exists already: expected a new file, or --force"));
  EXPECT_EQ(read("kept.h5"), "precious");

  const Outcome forced = run("run small.toml --out kept.h5 --force");
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_EQ(run("info kept.h5").exit_code, 0);
}

TEST_F(Usage, NothingIsWrittenAfterAnErrorOrWithoutAName) {
  for (const char* arguments :
       {"run small.toml", "run small.toml --out a.h5 --isa bogus",
        "run small.toml --out a.h5 --set needles.box=1", "run small.toml --out a.h5 --json --fast",
        "run small.toml --out a.h5 --set needles.count=4000000000"}) {
    run(arguments);
    EXPECT_EQ(files(), std::vector<std::string>{small}) << arguments;
  }
}

TEST_F(Usage, ResultsThatCannotBePrintedExitWith5) {
  for (const char* arguments : {"run small.toml --json", "run small.toml", "check small.toml"}) {
    EXPECT_TRUE(run(arguments, "", "/dev/full").fails(5, "standard output")) << arguments;
  }
}

}  // namespace
}  // namespace needlework
