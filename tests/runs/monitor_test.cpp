// Front ends other than the program follow runs, stop them, and hear of failures.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "src/runs/prepared_run.h"
#include "src/runs/progress_text.h"
#include "src/runs/sweep_run.h"
#include "tests/support/contains.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

/// Wants to be shown everything, and stops the run at a number of collisions.
struct Watcher : RunMonitor {
  explicit Watcher(std::uint64_t limit) : stop_at(limit) {}
  void begin(const Totals& initial, std::span<const Totals> samples, bool) override {
    EXPECT_DOUBLE_EQ(initial.energy, 2.5);
    begun_with.push_back(samples.size());
  }
  bool is_due(double) const override { return true; }
  void show(const Progress& progress) override {
    EXPECT_GE(progress.fraction, last_fraction);
    EXPECT_DOUBLE_EQ(progress.initial.energy, 2.5);
    last_fraction = progress.fraction;
    collisions = progress.now.collisions;
    ++shown;
  }
  void clear() override { ++cleared; }
  bool stop_requested() const override { return collisions >= stop_at; }

  std::uint64_t stop_at, collisions = 0;
  double last_fraction = 0;
  int shown = 0, cleared = 0;
  std::vector<std::size_t> begun_with;  // numbers of samples
};

// Samples divide the run into steps, after each of which the monitor is asked.
Scene scene_until(double collisions) {
  Scene scene = test::scene_of(50, 5);
  scene.until.collisions_per_needle = collisions;
  return scene;
}

TEST(RunMonitor, IsShownTheProgressOfARunToItsEnd) {
  Watcher watcher(1000000);
  PreparedRun prepared(complete_scene(scene_until(10)), false, "scene");
  const RunResult result = prepared.drive(watcher);
  EXPECT_EQ(result.stop, Stop::collisions);
  EXPECT_EQ(result.last.collisions, 250u);
  EXPECT_GT(watcher.shown, 5);
  EXPECT_GT(watcher.last_fraction, 0.3);
  EXPECT_EQ(watcher.cleared, 1);
  EXPECT_EQ(watcher.begun_with, std::vector<std::size_t>{1});  // the start
}

TEST(RunMonitor, StopsARun) {
  Watcher watcher(20);
  PreparedRun prepared(complete_scene(scene_until(1e6)), false, "scene");
  const RunResult result = prepared.drive(watcher);
  EXPECT_EQ(result.stop, Stop::interrupted);
  EXPECT_GE(result.last.collisions, 20u);
  EXPECT_LT(result.last.collisions, 10000000u);
  EXPECT_EQ(watcher.cleared, 1);
}

TEST(ProgressText, LeavesOutWholeItemsThatDoNotFit) {
  Progress progress{.elapsed = 3, .fraction = 0.423, .left = 12.3, .rate = 123456.7};
  progress.now.collisions = 161099;
  progress.now.time = 404.2;
  progress.initial.energy = 1;
  progress.now.energy = 0.3125;
  progress.energy_drift = -1.2e-16;
  progress.momentum_drift = 3.4e-16;
  progress.since_checkpoint = 2;
  const std::string line = progress_text(progress);
  EXPECT_EQ(line,
            "42.3 % done, 12.3 s left: 161099 collisions, drift E -1e-16, P 3e-16, time 404.2, "
            "E/E(0) = 0.312, 1.23e+05/s, saved 2.0 s ago");
  // On a terminal of 80 columns.
  EXPECT_EQ(whole_items(line, 79),
            "42.3 % done, 12.3 s left: 161099 collisions, drift E -1e-16, P 3e-16");
  EXPECT_EQ(whole_items(line, 200), line);
  EXPECT_EQ(whole_items(line, 40), "42.3 % done");
  EXPECT_EQ(whole_items(line, 4), "42.3");
}

struct SweepWatcher : SweepMonitor {
  bool is_due(double) const override { return true; }
  void show(double, double fraction, std::size_t finished, std::size_t members) override {
    EXPECT_LE(fraction, 1);
    last_finished = finished;
    EXPECT_EQ(members, 2u);
  }
  void report_failure(const sweep::Member& member, const Failure& failure) override {
    failures.push_back(member.name + ": " + failure.message);
  }
  bool stop_requested() const override { return stop; }

  bool stop = false;
  std::size_t last_finished = 0;
  std::vector<std::string> failures;
};

TEST(SweepMonitor, IsShownProgressAndFailuresAndStopsAllMembers) {
  const test::TemporaryFolder temporary;
  const std::string path = (temporary.path() / "grid.toml").string();
  std::ofstream(path) << "seeds = [1]\n[needles]\nbox = 5\n[initial]\nt_rot = 0\n"
                         "[until]\ncollisions_per_needle = 1\n"
                         "[parameters]\n\"needles.count\" = [1, 50]\n";
  const sweep::Grid grid = sweep::read_grid(path);
  const SweepFolder folder((temporary.path() / "out").string(), grid, false, "out");
  const std::vector<std::size_t> members{0, 1};
  const std::vector<double> costs = estimated_costs(grid);
  const MemberRuns runs{.grid = grid, .folder = folder, .members = members, .costs = costs};
  EXPECT_GT(estimated_memory(runs), 1e6);

  std::vector<int> codes(2, -1);
  SweepWatcher watcher;
  watcher.stop = true;
  run_members(runs, watcher, codes);
  EXPECT_EQ(codes, (std::vector<int>{stopped, stopped}));
  EXPECT_TRUE(watcher.failures.empty());

  watcher.stop = false;
  run_members(runs, watcher, codes);
  EXPECT_EQ(codes, (std::vector<int>{bad_input, ok}));
  EXPECT_EQ(watcher.last_finished, 2u);
  ASSERT_EQ(watcher.failures.size(), 1u);
  EXPECT_TRUE(watcher.failures[0].starts_with("count=1,seed=1: ")) << watcher.failures[0];
  EXPECT_TRUE(test::contains(watcher.failures[0], "nothing can ever happen"));
}

}  // namespace
}  // namespace needlework::runs
