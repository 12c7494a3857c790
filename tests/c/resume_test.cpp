// A run that was begun by any front end goes on in C as if it had never ended, and what cannot go
// on says why.
#include <filesystem>

#include "tests/c/c_simulation.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using test::cooling;
using test::CSimulation;

class CResume : public ProgramTest {
 protected:
  std::string scene_with_file(const std::string& more = "") const {
    return cooling + "output = { file = \"" + file + "\", events = true, frames = 3" + more +
           " }\n";
  }
  static std::string hash_at(std::uint64_t collisions) {
    const CSimulation whole(cooling);
    whole.run_to(collisions);
    return whole.hash();
  }
  void write_run(std::uint64_t collisions) const {
    const CSimulation first(scene_with_file());
    ASSERT_NE(first, nullptr) << first.error.message;
    first.run_to(collisions);
    EXPECT_EQ(needlework_close(first), NEEDLEWORK_OK);
  }

  const std::string file = path("gas.h5");
  const std::string checkpoint = file + ".checkpoint";
};

TEST_F(CResume, GivesTheTrajectoryOfTheWholeRun) {
  write_run(100);
  const CSimulation second = CSimulation::resumed(file);
  ASSERT_NE(second, nullptr) << second.error.message;
  EXPECT_EQ(second.error.code, NEEDLEWORK_OK);
  EXPECT_STREQ(second.error.message, "");
  EXPECT_EQ(second.totals().collisions, 100u);
  EXPECT_EQ(second.hash(), hash_at(100));
  second.run_to(250);  // from the start of the run
  EXPECT_EQ(second.hash(), hash_at(250));
  const CSimulation whole(cooling);
  EXPECT_EQ(second.totals().initial_energy, whole.totals().initial_energy);
}

TEST_F(CResume, SharesRunsWithTheProgram) {
  write("gas.toml", scene_with_file() + "until.collisions_per_needle = 2\n");
  ASSERT_EQ(run("run gas.toml --quiet").exit_code, 0);
  {
    const CSimulation second = CSimulation::resumed(file);
    ASSERT_NE(second, nullptr) << second.error.message;
    EXPECT_EQ(second.totals().collisions, 60u);
    second.run_to(100);
    EXPECT_EQ(needlework_close(second), NEEDLEWORK_OK);
  }
  EXPECT_EQ(
      json_of(
          "resume gas.h5 --set until.collisions_per_needle=5 --json --quiet")["trajectory_hash"],
      hash_at(150));
}

TEST_F(CResume, LeavesTheEndToTheProgramWhereTheSceneHasNone) {
  write_run(100);
  EXPECT_TRUE(
      run("resume gas.h5 --quiet").fails(3, "the run has no end: expected --set until.KEY=VALUE"));
  EXPECT_EQ(
      json_of(
          "resume gas.h5 --set until.collisions_per_needle=5 --json --quiet")["trajectory_hash"],
      hash_at(150));
}

TEST_F(CResume, UsesTheCheckpointBeforeADamagedOneAndWarns) {
  {
    const CSimulation first(scene_with_file());
    for (const std::uint64_t collisions : {50, 100}) {
      first.run_to(collisions);
      EXPECT_EQ(needlework_checkpoint(first), NEEDLEWORK_OK) << first.message();
    }
  }
  std::filesystem::resize_file(checkpoint, 1000);
  {
    const CSimulation second = CSimulation::resumed(file);
    ASSERT_NE(second, nullptr) << second.error.message;
    EXPECT_EQ(second.error.code, NEEDLEWORK_OK);
    EXPECT_TRUE(contains(second.error.message, "damaged"));
    EXPECT_EQ(second.totals().collisions, 50u);
    second.run_to(100);
    EXPECT_EQ(second.hash(), hash_at(100));
  }
  // It has been replaced by a whole one.
  std::filesystem::remove(checkpoint + ".old");
  EXPECT_EQ(CSimulation::resumed(file).totals().collisions, 50u);
  std::filesystem::resize_file(checkpoint, 1000);
  std::filesystem::remove(checkpoint + ".old");
  const CSimulation third = CSimulation::resumed(file);
  EXPECT_EQ(third, nullptr);
  EXPECT_EQ(third.error.code, NEEDLEWORK_INPUT);
  EXPECT_TRUE(std::string(third.error.message).starts_with(checkpoint + ": damaged"))
      << third.error.message;
}

TEST_F(CResume, NeedsACheckpointAndTheFile) {
  const CSimulation nothing = CSimulation::resumed(file);
  EXPECT_EQ(nothing, nullptr);
  EXPECT_EQ(nothing.error.code, NEEDLEWORK_IO);
  EXPECT_TRUE(contains(nothing.error.message, "No such file or directory"));
  write_run(10);
  std::filesystem::remove(file);
  EXPECT_EQ(needlework_resume(file.c_str(), nullptr), nullptr);
  const CSimulation without_file = CSimulation::resumed(file);
  EXPECT_EQ(without_file, nullptr);
  EXPECT_EQ(without_file.error.code, NEEDLEWORK_IO);
  EXPECT_TRUE(contains(without_file.error.message, file));
}

TEST_F(CResume, NeedsAFileThatMayHaveCheckpoints) {
  const CSimulation without_file(cooling);
  EXPECT_EQ(needlework_checkpoint(without_file), NEEDLEWORK_USAGE);
  EXPECT_EQ(without_file.message(),
            "the simulation has no output file, beside which checkpoints are written: expected "
            "output.file in its scene");
  {
    const CSimulation off(scene_with_file(", checkpoint_every = 0"));
    ASSERT_NE(off, nullptr) << off.error.message;
    EXPECT_EQ(needlework_checkpoint(off), NEEDLEWORK_USAGE);
    EXPECT_EQ(off.message(),
              "scene: line 3: output.checkpoint_every = 0: turns checkpoints off: expected a "
              "number > 0");
  }
  EXPECT_FALSE(exists("gas.h5.checkpoint"));
  const CSimulation closed(scene_with_file(), NEEDLEWORK_REPLACE);
  closed.run_to(10);
  EXPECT_EQ(needlework_close(closed), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_checkpoint(closed), NEEDLEWORK_USAGE);
  EXPECT_EQ(closed.message(), "the simulation is closed: expected one that can be run");
}

}  // namespace
}  // namespace needlework
