// A front end that advances a run piece by piece gets the same run, output included.
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/runs/prepared_run.h"
#include "tests/runs/silent.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

Scene cooling_scene(const std::string& file) {
  Scene scene = test::scene_of(60, 5);
  scene.collisions.epsilon = 0.9;
  scene.output.file = file;
  scene.until.collisions_per_needle = 8;
  return scene;
}

TEST(PreparedRun, WritesTheSameSeriesInOnePieceAndInMany) {
  const test::TemporaryFolder folder;
  const std::string whole = folder.path() / "whole.h5", pieces = folder.path() / "pieces.h5";
  Silent monitor;
  PreparedRun(complete_scene(cooling_scene(whole)), false, "scene").drive(monitor);

  PreparedRun run(complete_scene(cooling_scene(pieces)), false);
  while (run.simulation().collisions() < 240) {
    run.advance(from_now({.collisions = 7}, run.simulation()), monitor);
    if (run.simulation().collisions() > 233) break;
  }
  run.advance(run.scene().until, monitor);
  run.close();

  const auto expected = io::read_run(whole).series, actual = io::read_run(pieces).series;
  ASSERT_GT(expected.size(), 10u);
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(actual[n].time, expected[n].time);
    EXPECT_EQ(actual[n].energy, expected[n].energy);
    EXPECT_EQ(actual[n].collisions, expected[n].collisions);
  }
}

TEST(PreparedRun, StopsWhenTheCallerThrowsAndGoesOnWithoutALoss) {
  PreparedRun run(complete_scene(cooling_scene("")), false);
  std::size_t seen = 0;
  bool fails = true;
  run.on_collisions(10, [&](std::span<const Collision> batch) {
    if (fails) throw std::runtime_error("of the caller");
    EXPECT_LE(batch.size(), 10u);
    seen += batch.size();
  });
  Silent monitor;
  EXPECT_THROW(run.advance(from_now({.collisions = 200}, run.simulation()), monitor),
               std::runtime_error);
  const std::uint64_t stopped_at = run.simulation().collisions();
  EXPECT_EQ(stopped_at, 10u);  // before the next event
  fails = false;
  run.advance(from_start({.collisions = 200}, run.simulation()), monitor);
  EXPECT_EQ(seen, 190u);  // all but the batch that was refused

  PreparedRun undisturbed(complete_scene(cooling_scene("")), false);
  undisturbed.advance(from_start({.collisions = 200}, undisturbed.simulation()), monitor);
  EXPECT_EQ(run.simulation().trajectory_hash(), undisturbed.simulation().trajectory_hash());
}

// Several threads report many collisions after the one at which the caller has thrown.
TEST(Batches, AreNeverLargerThanAskedForAlsoAfterAFailure) {
  Simulation simulation(test::scene_of(50, 5));
  std::vector<std::size_t> sizes;
  bool fails = true;
  Batches<Collision> batches(simulation, 10, [&](std::span<const Collision> batch) {
    if (fails) throw std::runtime_error("of the caller");
    sizes.push_back(batch.size());
  });
  for (int n = 0; n < 35; ++n) batches.add({});
  EXPECT_THROW(batches.flush(), std::runtime_error);
  fails = false;
  batches.add({});
  batches.flush();
  EXPECT_EQ(sizes, (std::vector<std::size_t>{10, 10, 6}));
}

// Two programs that continue one run: the one that comes later must not take rows away.
TEST(PreparedRun, IsNotContinuedFromACheckpointThatIsNoLongerTheNewest) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.h5";
  Silent monitor;
  PreparedRun(complete_scene(cooling_scene(file)), false, "scene").drive(monitor);
  RunCheckpoint first = CheckpointFiles(file).latest().checkpoint, second = first;
  {
    PreparedRun run(std::move(first));
    run.advance(from_now({.collisions = 100}, run.simulation()), monitor);
    run.close();
  }
  const std::size_t rows = io::read_run(file).series.size();
  EXPECT_THROW(PreparedRun(std::move(second)), IoError);
  EXPECT_EQ(io::read_run(file).series.size(), rows);
}

}  // namespace
}  // namespace needlework::runs
