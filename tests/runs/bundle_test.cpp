// Runs that fail at an event or in the middle of one: what is left can be continued and replayed.
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "src/physics/gas.h"
#include "src/runs/checkpoint.h"
#include "src/runs/prepared_run.h"
#include "src/runs/replay.h"
#include "tests/runs/silent.h"
#include "tests/support/message_of.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

class Bundle : public testing::Test {
 protected:
  Bundle() {
    scene.collisions.epsilon = 0.9;
    scene.until.collisions_per_needle = 100;
    scene.output.file = folder.path() / "run.h5";
  }
  // A gas one needle of which is at the last box that can be counted.
  LoadedScene far_away() const {
    State state = draw_initial_state(scene);
    state.image.resize(state.size());
    state.image[7].fill(most_boxes);
    return complete_scene(scene, state);
  }

  const test::TemporaryFolder folder;
  Scene scene = test::scene_of(60, 5);
  Silent monitor;
};

TEST_F(Bundle, OfAnEventThatCannotBeShowsItAgain) {
  const RunResult result = PreparedRun(far_away(), false, "scene").drive(monitor);
  ASSERT_TRUE(result.failure);
  EXPECT_TRUE(result.failure->starts_with("needle 7 crosses more than")) << *result.failure;
  const CheckpointFiles files(scene.output.file);
  EXPECT_EQ(result.bundle, files.bundle());
  Replay replay(result.bundle, 5);
  const Replayed again = replay.drive(monitor);
  EXPECT_TRUE(again.same);
  EXPECT_EQ(again.failure, result.failure);
  for (const NumberedHappening& entry : again.last) {
    EXPECT_TRUE(entry.happening.event.first == 7 || entry.happening.event.second == 7);
  }
}

// The state before it is saved, and the file is whole.
TEST_F(Bundle, AStateBeforeAnEventThatCannotBeIsSaved) {
  PreparedRun run(far_away(), false, "scene");
  const RunResult result = run.drive(monitor);
  EXPECT_GT(result.last.collisions, 0u);
  RunCheckpoint saved = CheckpointFiles(scene.output.file).latest().checkpoint;
  const RunResult again = PreparedRun(saved).drive(monitor);
  EXPECT_EQ(again.failure, result.failure);
  EXPECT_EQ(again.collisions, 0u) << "it fails at once";
  EXPECT_EQ(again.last.collisions, result.last.collisions);
  saved = CheckpointFiles(scene.output.file).latest().checkpoint;
  saved.scene.until.time = result.last.time;
  const RunResult shorter = PreparedRun(saved).drive(monitor);
  EXPECT_FALSE(shorter.failure) << *shorter.failure;
  EXPECT_EQ(shorter.last.time, result.last.time);
}

TEST_F(Bundle, OfARunInPiecesIsNamedInTheError) {
  PreparedRun run(far_away(), false);
  const std::string message = test::message_of<InvalidStateError>([&] {
    for (int n = 1; n <= 100; ++n) run.advance(test::until_collisions(n), monitor);
  });
  EXPECT_TRUE(
      message.ends_with("; needlework replay " + scene.output.file + ".failure shows it again"))
      << message;
  EXPECT_TRUE(Replay(scene.output.file + ".failure", 0).drive(monitor).same);
  EXPECT_THROW(run.advance(scene.until, monitor), InvalidStateError) << "it cannot go on";
  EXPECT_EQ(run.why_not_saved(), "");
  run.close();
}

// A defect outside the engine, which a replay does not meet.
TEST_F(Bundle, OfAnyDefectIsKeptAndAReplayWithoutItPasses) {
  PreparedRun run(complete_scene(scene), false, "scene");
  run.advance(test::until_collisions(2), monitor);
  run.simulation().on_collision([](const Collision&) { throw std::logic_error("a defect"); });
  const RunResult result = run.drive(monitor);
  EXPECT_EQ(result.failure, "unexpected error: a defect");
  EXPECT_EQ(result.last.collisions, 61u);
  Replay replay(result.bundle, 5);
  ASSERT_TRUE(replay.failure());
  EXPECT_EQ(replay.failure()->message, result.failure);
  const Replayed again = replay.drive(monitor);
  EXPECT_FALSE(again.failure || again.same);
  EXPECT_EQ(again.collisions, 62u);
  EXPECT_EQ(again.last.size(), 5u) << "of all needles";
  EXPECT_EQ(again.last.back().number, 62u);
}

// As drive() does: the state is not saved, and the bundle is named.
TEST_F(Bundle, OfADefectInARunInPiecesIsNamedInTheError) {
  PreparedRun run(complete_scene(scene), false);
  run.advance(from_now({.collisions = 20}, run.simulation()), monitor);
  run.simulation().on_collision([](const Collision&) { throw std::logic_error("a defect"); });
  EXPECT_EQ(test::message_of<UnfinishedEventError>([&] { run.advance(scene.until, monitor); }),
            "unexpected error: a defect; needlework replay " + scene.output.file +
                ".failure shows it again");
  EXPECT_NE(run.why_not_saved(), "");
  run.close();
  const CheckpointFiles files(scene.output.file);
  EXPECT_EQ(files.latest().checkpoint.output.samples, 1u)
      << "the checkpoint before the first event";
  EXPECT_EQ(Replay(files.bundle(), 0).failure()->collisions, 21u);
}

TEST_F(Bundle, IsNamedFromTheFolderOfTheProcess) {
  const std::filesystem::path before = std::filesystem::current_path();
  const auto bundle_after_moving_to = [&](const std::filesystem::path& end) {
    std::filesystem::current_path(folder.path());
    scene.output.file = "run.h5";
    PreparedRun run(far_away(), true, "scene");
    std::filesystem::current_path(end);
    return run.drive(monitor).bundle;
  };
  const std::string here = bundle_after_moving_to(folder.path());
  const std::string elsewhere = bundle_after_moving_to(before);
  std::filesystem::current_path(before);
  EXPECT_EQ(here, "run.h5.failure");
  EXPECT_EQ(elsewhere, folder.path() / "run.h5.failure");
}

TEST_F(Bundle, IsNotReplacedByAnErrorOfTheCaller) {
  PreparedRun run(far_away(), false);
  run.on_collisions(1000000,
                    [](std::span<const Collision>) { throw std::runtime_error("of the caller"); });
  EXPECT_THROW(run.advance(scene.until, monitor), InvalidStateError);
}

TEST_F(Bundle, NeedsAStartThatIsKnown) {
  scene.output.checkpoint_every = 0;
  const RunResult result = PreparedRun(far_away(), false, "scene").drive(monitor);
  EXPECT_EQ(result.bundle, "");
  EXPECT_TRUE(result.failure->ends_with("no bundle for needlework replay: its start is in no file"))
      << *result.failure;
}

}  // namespace
}  // namespace needlework::runs
