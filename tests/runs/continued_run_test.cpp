// Runs that continue from checkpoints: what is accepted, and what is left when something fails.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "needlework/error.h"
#include "src/machine/stop_request.h"
#include "src/runs/prepared_run.h"
#include "src/trajectory/saved_totals.h"
#include "tests/runs/silent.h"
#include "tests/support/contains.h"
#include "tests/support/message_of.h"
#include "tests/support/runs.h"
#include "tests/support/saved_gas.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

class ContinuedRun : public testing::Test {
 protected:
  ContinuedRun() {
    scene.collisions.epsilon = 0.9;
    scene.until.collisions_per_needle = 8;
    scene.output.file = folder.path() / "run.h5";
  }
  // The checkpoint of a run that has ended.
  RunCheckpoint ended() {
    PreparedRun(complete_scene(scene), true, "scene").drive(monitor);
    return CheckpointFiles(scene.output.file).latest().checkpoint;
  }
  static std::string complaint_about(RunCheckpoint checkpoint) {
    return test::message_of<InputError>([&] { PreparedRun run(std::move(checkpoint)); });
  }

  const test::TemporaryFolder folder;
  Scene scene = test::scene_of(60, 5);
  Silent monitor;
};

TEST_F(ContinuedRun, HasTheBoxOfItsScene) {
  RunCheckpoint saved = ended();
  test::SavedGas gas(saved.scene, saved.simulation);
  gas.physics[0] = 10;
  saved.simulation = gas.checkpoint();
  EXPECT_EQ(complaint_about(saved),
            saved.origin.path +
                ": the saved state is of another box, or of other needles, collisions or accuracy "
                "than those of the scene: expected the same");
}

// With which the end of the run would be compared.
TEST_F(ContinuedRun, HasTheLastSampleOfARunThatHasBegun) {
  RunCheckpoint saved = ended();
  std::string one, none;
  // The last row is that of the end, before which the run was saved.
  const std::optional<Totals> sample = io::read_run(scene.output.file).series.rbegin()[1];
  const auto put = [](std::string& bytes, std::optional<Totals> totals) {
    Archive archive = Archive::to(bytes);
    archive(totals);
  };
  put(one, sample);
  put(none, {});
  const auto at = saved.observation.find(one);
  ASSERT_NE(at, std::string::npos);
  saved.observation.replace(at, one.size(), none);
  EXPECT_TRUE(test::contains(complaint_about(saved), "its parts do not belong together"));
}

// A replay shows nobody the course, and a function that is called for each collision costs time.
TEST_F(ContinuedRun, KeepsItsCourseOnlyIfItIsSavedAgain) {
  scene.collisions.epsilon = 1;
  RunCheckpoint saved = ended();
  saved.scene.until.collisions_per_needle = 300;
  const RunResult with_file = PreparedRun(saved).drive(monitor);
  EXPECT_GT(with_file.samples.size(), 2u);
  EXPECT_GT(with_file.system_rate.batches, 0);
  saved.scene.output.file.clear();
  const RunResult without = PreparedRun(saved).drive(monitor);
  EXPECT_TRUE(without.samples.empty());
  EXPECT_EQ(without.system_rate.batches, 0);
  EXPECT_EQ(without.last.collisions, with_file.last.collisions);
}

TEST_F(ContinuedRun, IsStoppedWhileItIsRead) {
  const RunCheckpoint saved = ended();
  const CheckpointFiles files(scene.output.file);
  const StopRequest request([] { return "enough"; });
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_THROW(files.latest(), StoppedEarly);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_THROW(PreparedRun run(saved), StoppedEarly);
}

// The damaged one must not take the place of the one before.
TEST_F(ContinuedRun, HasTwoCheckpointsAgainAfterOneWasDamaged) {
  ended();
  const CheckpointFiles files(scene.output.file);
  std::filesystem::resize_file(files.newest(), 1000);
  auto [saved, warning] = files.latest();
  EXPECT_NE(warning, "");
  const std::string start = saved.observation;
  PreparedRun run(std::move(saved));
  EXPECT_EQ(CheckpointFiles::read(files.older()).observation, start);
  EXPECT_EQ(CheckpointFiles::read(files.newest()).observation, start);
  run.drive(monitor);
  EXPECT_EQ(CheckpointFiles::read(files.older()).observation, start);
  EXPECT_EQ(files.latest().warning, "");
}

TEST_F(ContinuedRun, IsNotContinuedTwiceAfterACheckpointWasDamaged) {
  ended();
  const CheckpointFiles files(scene.output.file);
  std::filesystem::resize_file(files.newest(), 1000);
  RunCheckpoint first = files.latest().checkpoint, second = first;
  PreparedRun(std::move(first)).drive(monitor);
  EXPECT_THROW(PreparedRun(std::move(second)), IoError);
}

}  // namespace
}  // namespace needlework::runs
