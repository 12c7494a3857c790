#include "src/cli/watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "needlework/theory.h"
#include "src/observe/forecast.h"
#include "src/runs/loaded_scene.h"
#include "tests/support/runs.h"

namespace needlework::cli {
namespace {

// A gas of 100 needles in a box of edge 10, so of density 0.1, that starts with these temperatures.
Scene cooling_scene() {
  Scene scene = test::scene_of(100, 10);
  scene.collisions.epsilon = 0.8;
  return scene;
}

Totals totals_at(double time, double t_tr, double t_rot, std::uint64_t collisions) {
  Totals totals;
  totals.time = time;
  totals.t_tr = t_tr;
  totals.t_rot = t_rot;
  totals.energy = 1.5 * t_tr + t_rot;
  totals.collisions = collisions;
  return totals;
}

TEST(WatchedRun, ShowsEnergyRatioAndRateBesideTheory) {
  const Scene scene = cooling_scene();
  WatchedRun run(scene, totals_at(0, 1, 1, 0));
  run.add(totals_at(10, 0.5, 0.25, 200));
  run.add(totals_at(30, 0.2, 0.2, 500));
  const std::vector<picture::Panel> panels = run.panels();
  ASSERT_EQ(panels.size(), 3);
  for (const picture::Panel& panel : panels) {
    ASSERT_EQ(panel.curves.size(), 2);
    EXPECT_EQ(panel.curves[0].name, "theory");
    EXPECT_TRUE(panel.x.logarithmic && panel.y.logarithmic);
  }
  const auto measured = [&](std::size_t i) { return panels[i].curves[1]; };
  EXPECT_EQ(measured(0).x, (std::vector<double>{10, 30}));
  EXPECT_EQ(measured(0).y, (std::vector<double>{0.4, 0.2}));
  EXPECT_EQ(measured(1).y, (std::vector<double>{2, 1}));
  EXPECT_EQ(measured(2).x, (std::vector<double>{5, 20}));
  // 200 collisions in a time of 10, then 300 in 20, of two needles each, among 100 needles.
  EXPECT_NEAR(measured(2).y[0], 0.4, 1e-12);
  EXPECT_NEAR(measured(2).y[1], 0.3, 1e-12);

  const theory::Gas gas{scene.needles.k, 0.8, -1};
  const double tau = theory_time_scale(0.1) * 30;
  const auto expected = theory::cooling_curve(gas, {1, 1}, std::span(&tau, 1)).front();
  EXPECT_NEAR(panels[0].curves[0].y[1], expected.energy() / 2.5, 1e-9);
  EXPECT_NEAR(panels[1].curves[0].y[1], expected.t_tr / expected.t_rot, 1e-9);
  EXPECT_NEAR(panels[2].curves[0].y[1], theory::collision_rate(0.1, expected, gas.k), 1e-9);
}

TEST(WatchedRun, MeasuresARateOverEnoughCollisions) {
  WatchedRun run(cooling_scene(), totals_at(0, 1, 1, 0));
  for (int i = 1; i <= 10; ++i) run.add(totals_at(i, 1, 1, static_cast<std::uint64_t>(30 * i)));
  const picture::Curve rate = run.panels()[2].curves[1];
  EXPECT_EQ(rate.x, (std::vector<double>{2, 6}));  // from 0 to 4, and from 4 to 8
  for (const double y : rate.y) EXPECT_NEAR(y, 0.6, 1e-12);
}

TEST(WatchedRun, KeepsTwoHundredInstantsADecadeHoweverManyAreShown) {
  WatchedRun run(cooling_scene(), totals_at(0, 1, 1, 0));
  for (int i = 0; i <= 100000; ++i) {
    run.add(totals_at(std::pow(10, i / 25000.0 - 1), 1, 1, static_cast<std::uint64_t>(i)));
  }
  EXPECT_GT(run.size(), 700);  // four decades
  EXPECT_LT(run.size(), 900);
}

TEST(WatchedRun, HasNoTheoryForAStateFromAFileOrAtRestOrSetByACaller) {
  Scene from_file = cooling_scene();
  from_file.initial.file = "state.h5";
  WatchedRun run(from_file, totals_at(0, 1, 1, 0));
  run.add(totals_at(1, 1, 1, 1000));
  for (const picture::Panel& panel : run.panels()) EXPECT_EQ(panel.curves.size(), 1);
  WatchedRun set(cooling_scene(), totals_at(0, 1, 1, 0), false);
  set.add(totals_at(1, 1, 1, 1000));
  EXPECT_EQ(set.panels()[0].curves.size(), 1);
  WatchedRun at_rest(cooling_scene(), totals_at(0, 0, 0, 0));
  at_rest.add(totals_at(1, 0, 0, 0));
  EXPECT_EQ(at_rest.panels()[0].curves.size(), 1);
}

TEST(WatchLines, ShowAsManyChartsAsFit) {
  WatchedRun run(cooling_scene(), totals_at(0, 1, 1, 0));
  run.add(totals_at(1, 0.5, 0.5, 1000));
  const auto titles = [&](std::size_t columns, std::size_t rows) {
    std::string found;
    const auto lines = watch_lines(run.panels(), {columns, rows}, false);
    EXPECT_LE(lines.size(), rows);
    for (const std::string& line : lines) {
      for (const char* title : {"E/E(0)", "T_tr/T_rot", "collision rate"}) {
        if (line.find(title) != line.npos) found += std::string(title) + ", ";
      }
      if (line.find("theory") != line.npos) found += "| ";
    }
    return found;
  };
  EXPECT_EQ(titles(130, 20), "E/E(0), T_tr/T_rot, collision rate, | ");
  EXPECT_EQ(titles(80, 22), "E/E(0), T_tr/T_rot, | collision rate, | ");
  EXPECT_EQ(titles(80, 12), "E/E(0), T_tr/T_rot, | ");
  EXPECT_EQ(titles(60, 40), "E/E(0), | T_tr/T_rot, | collision rate, | ");
  EXPECT_EQ(titles(30, 7), "E/E(0), | ");
  EXPECT_EQ(titles(10, 7), "");
  EXPECT_EQ(titles(80, 2), "");
}

}  // namespace
}  // namespace needlework::cli
