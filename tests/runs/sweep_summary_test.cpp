// Means and standard errors over seeds.
#include "src/runs/sweep_summary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace needlework::runs::sweep {
namespace {

TEST(Estimate, IsMeanAndStandardErrorOfIt) {
  const double values[] = {1, 2, 6};
  const Estimate three = estimate(values);
  EXPECT_DOUBLE_EQ(three.mean, 3);
  EXPECT_DOUBLE_EQ(three.standard_error, std::sqrt(14.0 / 6));
}

TEST(Estimate, IsUndefinedWhereThereIsTooLittle) {
  const double one = 4;
  EXPECT_EQ(estimate({&one, 1}).mean, 4);
  EXPECT_TRUE(std::isnan(estimate({&one, 1}).standard_error));
  EXPECT_TRUE(std::isnan(estimate({}).mean));
}

Grid two_seeds() {
  Grid grid;
  grid.seeds = {1, 2};
  grid.members.resize(2);
  grid.members[0].seed = 1;
  grid.members[1].seed = 2;
  return grid;
}

io::RecordedRun run_sampled_at(std::vector<double> times, double energy) {
  io::RecordedRun run;
  run.needles = 10;
  for (const double time : times) {
    Totals sample;
    sample.time = time;
    sample.energy = energy;
    sample.collisions = static_cast<std::uint64_t>(10 * time);
    run.series.push_back(sample);
  }
  return run;
}

TEST(Summary, HasTheTimesThatAllRunsHave) {
  const auto summary = summarise(two_seeds(), [](const Member& member) {
    return std::optional(member.seed == 1 ? run_sampled_at({0, 0.5, 1, 2, 2.5}, 3)
                                          : run_sampled_at({0, 0.5, 1, 1.7}, 5));
  });
  ASSERT_EQ(summary.size(), 1u);
  EXPECT_EQ(summary[0].times, (std::vector<double>{0, 0.5, 1}));
  const Series& energy = summary[0].series[2];
  EXPECT_EQ(energy.name, "energy");
  ASSERT_EQ(energy.estimates.size(), 3u);
  EXPECT_EQ(energy.estimates[2].mean, 4);
  EXPECT_EQ(energy.estimates[2].standard_error, 1);
  EXPECT_EQ(summary[0].results[0].name, "time");
  EXPECT_DOUBLE_EQ(summary[0].results[0].estimate.mean, 2.1);
}

TEST(Summary, HasWhatWallsAndDrivingHaveDone) {
  Grid grid = two_seeds();
  for (Member& member : grid.members) {
    member.scene.walls = {{.axis = "z", .side = "both"}};
    member.scene.driving.kicks = {.every = 1, .translational = 1, .rotational = 0};
  }
  const auto summary = summarise(grid, [](const Member& member) {
    io::RecordedRun run = run_sampled_at({0, 2}, 5);
    const double more = member.seed == 1 ? 0 : 2;
    // In another order than the scene has.
    run.walls = {{2, true, 7, 3.0}, {2, false, 5, 4.0 + more}};
    run.pressure = {1, 1.5 + more};
    run.energy.pairs = -3;
    run.energy.walls = {0.5, 0.25 + more};
    run.energy.kicks = 2 + more;
    return std::optional(run);
  });
  const auto mean = [&](const std::string& name) {
    for (const Result& result : summary.at(0).results) {
      if (result.name == name) return result.estimate.mean;
    }
    ADD_FAILURE() << name;
    return 0.0;
  };
  EXPECT_EQ(mean("hits_z_high"), 7);
  EXPECT_EQ(mean("impulse_z_low"), 5);
  EXPECT_EQ(mean("pressure_z_high"), 1);
  EXPECT_EQ(mean("pressure_z_low"), 2.5);
  EXPECT_EQ(mean("budget_z_high"), 0.5);
  EXPECT_EQ(mean("budget_z_low"), 1.25);
  EXPECT_EQ(mean("budget_pairs"), -3);
  EXPECT_EQ(mean("budget_kicks"), 3);
  for (const Result& result : summary[0].results) EXPECT_NE(result.name, "budget_thermostat");
}

TEST(Summary, LeavesOutWhatIsNotThere) {
  const auto summary = summarise(two_seeds(), [](const Member& member) {
    return member.seed == 2 ? std::optional(run_sampled_at({0, 1}, 5)) : std::nullopt;
  });
  EXPECT_EQ(summary[0].seeds, std::vector<std::uint64_t>{2});
  EXPECT_EQ(summary[0].times.size(), 2u);
  const auto nothing =
      summarise(two_seeds(), [](const Member&) { return std::optional<io::RecordedRun>(); });
  EXPECT_TRUE(nothing[0].seeds.empty());
  EXPECT_TRUE(nothing[0].times.empty());
  EXPECT_TRUE(std::isnan(nothing[0].results[0].estimate.mean));
}

}  // namespace
}  // namespace needlework::runs::sweep
