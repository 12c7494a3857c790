// Jobs of batch systems: their signals and limits on wall time end a run in order, in every phase.
#include <array>
#include <chrono>
#include <csignal>
#include <thread>

#include "src/cli/signals.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

class BatchSystem : public ProgramTest {};

TEST_F(BatchSystem, SignalsSaveAndEndARun) {
  write("endless.toml", "needles = {count = 100, box = 6}\nuntil.time = 1e12\n");
  for (const std::string signal : {"INT", "USR1", "USR2", "XCPU", "TERM"}) {
    const std::string file = signal + ".h5";
    const Outcome stopped =
        run_and_signal("run endless.toml --json --set output.frames=[0.01] --out " + file,
                       "'" NEEDLEWORK_PROGRAM "' info " + file + " | grep '2 frames'", signal);
    EXPECT_TRUE(stopped.fails(75, "stopped by a signal at time ")) << signal;
    EXPECT_EQ(stopped.json()["stop"], "interrupted");
    EXPECT_TRUE(contains(run("info " + file).out, "3 frames"));
    EXPECT_EQ(run("resume " + file + " --quiet --set until.wall_s=0").exit_code, 75) << signal;
  }
}

// Ends by the first search alone: it takes most of a minute if it is not stopped.
TEST_F(BatchSystem, TheFirstSearchIsStopped) {
  write("dense.toml",
        "needles = {count = 150000, box = 2.01}\nuntil.collisions_per_needle = 1000\n");
  const Outcome stopped =
      run_and_signal("run dense.toml --quiet --out dense.h5", "ls dense.h5.checkpoint", "USR1");
  EXPECT_EQ(stopped.exit_code, 75);
  EXPECT_TRUE(contains(stopped.err, "stopped by a signal at time 0 after 0 collisions (saved in "));
  const Outcome again = run("resume dense.h5 --quiet --set until.wall_s=0.3");
  EXPECT_EQ(again.exit_code, 75);
  EXPECT_TRUE(contains(again.err, "stopped by until.wall_s"));
  EXPECT_EQ(run("info dense.h5").exit_code, 0);
}

TEST_F(BatchSystem, DrawingAStateIsStopped) {
  write("large.toml", "needles = {count = 5_000_000, box = 200}\nuntil.time = 1\n");
  EXPECT_TRUE(run("run large.toml --out large.h5 --set until.wall_s=0.01 --log log")
                  .fails(75, "stopped by until.wall_s before the run began (nothing is saved)"));
  EXPECT_FALSE(exists("large.h5"));
  EXPECT_TRUE(contains(read("log"), "\"exit_code\":75"));
}

// Rods of which the placing would take a minute.
TEST_F(BatchSystem, PlacingRodsIsShownAndStopped) {
  write("rods.toml", R"(needles.box = 31
until.time = 1
species = [{ name = "rods", count = 3000, length = 5, diameter = 1 }]
)");
  const std::string command = "run rods.toml --set until.wall_s=1 --progress-every 0.2";
  const char* const stage = " rods";
  const Outcome shown = run(command);
  EXPECT_EQ(shown.exit_code, 75);
  EXPECT_TRUE(contains(shown.err, stage));
  const char* const why = "needlework: stopped by until.wall_s before the run began";
  EXPECT_TRUE(contains(shown.err, why));
  for (const char* option : {" --json", " --quiet"}) {
    EXPECT_FALSE(contains(run(command + option).err, stage)) << option;
  }
}

// Slurm sends SIGUSR1 and then SIGTERM, a limit on CPU time SIGXCPU every second.
TEST(SignalGuard, IsNotHurriedByWarnings) {
  const cli::SignalGuard guard;
  const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(250)); };
  for (const int signal : {SIGXCPU, SIGUSR1, SIGXCPU, SIGUSR2, SIGTERM, SIGXCPU}) {
    raise(signal);
    EXPECT_EQ(cli::SignalGuard::received(), SIGXCPU);
    wait();
  }
  EXPECT_EXIT(raise(SIGTERM), testing::KilledBySignal(SIGTERM), "");
}

TEST(SignalGuard, LeavesIgnoredWarningsIgnored) {
  struct sigaction before {};
  struct sigaction ignored {};
  ignored.sa_handler = SIG_IGN;
  sigaction(SIGUSR1, &ignored, &before);
  {
    const cli::SignalGuard guard;
    raise(SIGUSR1);
    EXPECT_EQ(cli::SignalGuard::received(), 0);
  }
  sigaction(SIGUSR1, &before, nullptr);
}

}  // namespace
}  // namespace needlework
