// Files that a C program writes are those of the program, and nothing is lost.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "tests/c/c_simulation.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using test::Arrays;
using test::cooling;
using test::CSimulation;
using test::expect_same_start;

class COutput : public ProgramTest {
 protected:
  std::string scene_with_file(const std::string& more = "") const {
    return cooling + more + "output.file = \"" + path("gas.h5") + "\"\n";
  }
  std::string info(const std::string& name) const { return output_of("info " + name); }
};

TEST_F(COutput, IsReadByTheProgram) {
  const CSimulation simulation(scene_with_file("output.events = true\n"));
  ASSERT_NE(simulation, nullptr) << simulation.error.message;
  simulation.run_to(100);
  simulation.run_to(200);
  EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_OK) << "does nothing again";
  const std::string text = info("gas.h5");
  EXPECT_TRUE(contains(text, {"60 particles", "[200]"}));  // collisions
  EXPECT_EQ(simulation.totals().collisions, 200u) << "it can still be looked at";
  needlework_limits limits{};
  limits.collisions = 300;
  EXPECT_EQ(needlework_run_until(simulation, &limits, nullptr), NEEDLEWORK_USAGE);
  EXPECT_EQ(simulation.message(), "the simulation is closed: expected one that can be run");
}

// A forked child has the state of the fork, and would write it when it ends.
TEST_F(COutput, IsLeftAloneByForkedChildren) {
  enum { destroys, closes, advances, exits };
  for (const int what : {destroys, closes, advances, exits}) {
    std::filesystem::remove(path("gas.h5"));
    const CSimulation simulation(scene_with_file("output.events = true\n"));
    ASSERT_NE(simulation, nullptr) << simulation.error.message;
    simulation.run_to(100);
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
      close(ready[1]);
      char byte;
      if (::read(ready[0], &byte, 1) != 0) _exit(99);  // until the parent is done
      int code = NEEDLEWORK_IO;
      needlework_limits limits{};
      limits.collisions = 5000;
      if (what == closes) code = needlework_close(simulation);
      if (what == advances) code = needlework_run_until(simulation, &limits, nullptr);
      if (what == destroys) needlework_destroy(simulation);
      if (what == exits) exit(NEEDLEWORK_IO);  // HDF5 writes what it holds
      _exit(code);
    }
    close(ready[0]);
    simulation.run_to(200);
    EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_OK);
    const std::string before = read("gas.h5"), checkpoint = read("gas.h5.checkpoint");
    close(ready[1]);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status)) << what;
    EXPECT_EQ(WEXITSTATUS(status), NEEDLEWORK_IO) << what;
    EXPECT_TRUE(read("gas.h5") == before && read("gas.h5.checkpoint") == checkpoint) << what;
  }
}

TEST_F(COutput, IsTheFileOfTheProgram) {
  const std::string end = "until.collisions_per_needle = 5\n";
  write("gas.toml", scene_with_file(end));
  ASSERT_EQ(run("run gas.toml --quiet").exit_code, 0);
  const std::string expected = info("gas.h5");
  ASSERT_EQ(run("export gas.h5 program.vtkhdf").exit_code, 0);
  std::filesystem::remove(path("gas.h5"));
  {
    const CSimulation simulation(scene_with_file(end));
    EXPECT_EQ(needlework_run_until(simulation, nullptr, nullptr), NEEDLEWORK_OK);
    EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_OK);
  }
  EXPECT_EQ(info("gas.h5"), expected);
  ASSERT_EQ(run("export gas.h5 c.vtkhdf").exit_code, 0);
  EXPECT_EQ(read("c.vtkhdf"), read("program.vtkhdf")) << "the last frames";
}

TEST_F(COutput, IsCompleteUpToTheLastSampleIfItIsNotClosed) {
  {
    const CSimulation simulation(scene_with_file());
    simulation.run_to(100);
  }
  EXPECT_TRUE(contains(info("gas.h5"), "60 particles"));
}

// The folder is away for a while, as that of a network may be.
TEST_F(COutput, IsFreeForOthersAfterItCouldNotBeClosed) {
  const std::string folder = path("there"), away = path("away");
  std::filesystem::create_directory(folder);
  const CSimulation simulation(cooling + "output.file = \"" + folder + "/gas.h5\"\n");
  simulation.run_to(100);
  EXPECT_EQ(needlework_checkpoint(simulation), NEEDLEWORK_OK);
  std::filesystem::rename(folder, away);
  EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_IO);
  EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_OK) << "it has been told";
  std::filesystem::rename(away, folder);
  const CSimulation again = CSimulation::resumed(folder + "/gas.h5");
  ASSERT_NE(again, nullptr) << again.error.message;
  EXPECT_EQ(again.hash(), simulation.hash());
}

TEST_F(COutput, KeepsAFileThatExistsUnlessItIsToBeReplaced) {
  write("gas.h5", "precious");
  const CSimulation refused(scene_with_file());
  EXPECT_EQ(refused, nullptr);
  EXPECT_EQ(refused.error.code, NEEDLEWORK_IO);
  EXPECT_TRUE(contains(
      refused.error.message,
      {"output.file = ", "gas.h5\": exists already: expected a new file, or NEEDLEWORK_REPLACE"}));
  EXPECT_EQ(read("gas.h5"), "precious");
  const CSimulation replaces(scene_with_file(), NEEDLEWORK_REPLACE);
  ASSERT_NE(replaces, nullptr) << replaces.error.message;
  replaces.run_to(10);
  EXPECT_EQ(needlework_close(replaces), NEEDLEWORK_OK);
  EXPECT_TRUE(contains(info("gas.h5"), "60 particles"));
}

TEST_F(COutput, DoesNotReplaceAFileThatIsBeingWritten) {
  const CSimulation first(scene_with_file());
  first.run_to(10);
  const CSimulation second(scene_with_file(), NEEDLEWORK_REPLACE);
  EXPECT_EQ(second, nullptr);
  EXPECT_EQ(second.error.code, NEEDLEWORK_IO);
  const std::string refusal = "cannot be replaced: another program or simulation has the file open";
  EXPECT_TRUE(contains(second.error.message, refusal));
  const CSimulation without_file(cooling);
  const std::string file = path("gas.h5");
  EXPECT_EQ(needlework_write_state(without_file, file.c_str(), NEEDLEWORK_REPLACE), NEEDLEWORK_IO);
  EXPECT_TRUE(contains(without_file.message(), refusal));
  EXPECT_EQ(files(), (std::vector<std::string>{"gas.h5", "gas.h5.checkpoint", "small.toml"}));
  EXPECT_EQ(needlework_close(first), NEEDLEWORK_OK) << "its file is still there";
  const CSimulation third(scene_with_file(), NEEDLEWORK_REPLACE);
  EXPECT_NE(third, nullptr) << third.error.message;
}

TEST_F(COutput, OfAStateStartsAnotherSimulation) {
  const CSimulation first(cooling);
  first.run_to(100);
  const std::string file = path("state.h5");
  EXPECT_EQ(needlework_write_state(first, file.c_str(), 0), NEEDLEWORK_OK) << first.message();
  const CSimulation second("initial.file = \"" + file + "\"\ncollisions = { epsilon = 0.9 }\n");
  ASSERT_NE(second, nullptr) << second.error.message;
  expect_same_start(Arrays(second), Arrays(first));
  EXPECT_EQ(Arrays(second).image, Arrays(first).image);
  EXPECT_EQ(second.totals().time, 0);
  EXPECT_NEAR(second.totals().energy, first.totals().energy, 1e-14);
}

TEST_F(COutput, OfAStateKeepsWhatExistsUnlessItIsToBeReplaced) {
  const CSimulation simulation(cooling);
  write("state.h5", "precious");
  const std::string file = path("state.h5");
  EXPECT_EQ(needlework_write_state(simulation, file.c_str(), 0), NEEDLEWORK_IO);
  EXPECT_TRUE(simulation.message().starts_with(file + ": ")) << simulation.message();
  EXPECT_TRUE(contains(simulation.message(), "or NEEDLEWORK_REPLACE"));
  EXPECT_EQ(read("state.h5"), "precious");
  EXPECT_EQ(needlework_write_state(simulation, file.c_str(), NEEDLEWORK_REPLACE), NEEDLEWORK_OK);
  EXPECT_TRUE(contains(info("state.h5"), "60 particles"));
  EXPECT_EQ(files(), (std::vector<std::string>{"small.toml", "state.h5"}));
}

TEST_F(COutput, OfAStateDoesNotReplaceTheFileThatIsBeingWritten) {
  const CSimulation simulation(scene_with_file());
  const std::string file = path("gas.h5");
  EXPECT_EQ(needlework_write_state(simulation, file.c_str(), NEEDLEWORK_REPLACE), NEEDLEWORK_USAGE);
  EXPECT_TRUE(contains(simulation.message(), "is the output file"));
  EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_write_state(simulation, file.c_str(), NEEDLEWORK_REPLACE), NEEDLEWORK_OK);
}

// A limit on the size of files takes the part of a full disk. It is for a process of its own.
class COutputOnAFullDisk : public COutput {};

TEST_F(COutputOnAFullDisk, IsAnErrorThatLeavesTheSimulationAndOldFilesWhole) {
  const Outcome outcome = shell("ulimit -f 600; trap '' XFSZ; '" NEEDLEWORK_FULL_DISK "' .");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_TRUE(contains(info("old.h5"), "60 particles")) << "the state of before";
}

}  // namespace
}  // namespace needlework
