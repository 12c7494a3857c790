// What files, totals and reports say of hits on walls, beside collisions of two needles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "needlework/h5md.h"
#include "src/io/contents.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/prepared_run.h"
#include "tests/runs/silent.h"
#include "tests/support/real.h"
#include "tests/support/runs.h"

namespace needlework::runs {
namespace {

using WallsOutput = InRunFolder;

// Between walls along z and over a wall along x, to which gravity points.
Scene walled(const std::string& file = "") {
  Scene scene = test::scene_of(80, 5);
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc = 1e-4;
  scene.forces.gravity = {-0.5, 0, 0.2};
  scene.walls.resize(2);
  scene.walls[0].axis = "z";
  scene.walls[0].side = "both";
  scene.walls[0].epsilon = 0.8;
  scene.walls[1].axis = "x";
  scene.walls[1].side = "low";
  scene.output.file = file;
  scene.output.events = true;
  scene.output.series_every = 0.5;
  scene.output.frame_times = {1};
  scene.output.observables = {"collision_statistics", "wall_profiles", "centre_of_mass"};
  scene.until.time = 3;
  return scene;
}

TEST_F(WallsOutput, EventsAndTotalsAreThoseOfTheReports) {
  std::vector<Happening> seen;
  std::size_t collisions = 0;
  PreparedRun run(complete_scene(walled(file)), false);
  run.on_happenings(16, [&](auto batch) { seen.insert(seen.end(), batch.begin(), batch.end()); });
  run.on_collisions(5, [&](auto batch) { collisions += batch.size(); });
  finish(run);

  std::vector<std::uint64_t> hits(3);
  std::vector<test::Wide> impulse(3);
  for (const Happening& each : seen) {
    if (each.is_collision()) continue;
    ASSERT_EQ(each.kind, Happening::wall);
    const Collision& hit = each.event;
    ++hits.at(hit.second);
    impulse[hit.second] += std::abs(hit.impulse[hit.second == 2 ? 0 : 2]);
    EXPECT_EQ(std::abs(hit.arm_first), 0.5);
    EXPECT_EQ(hit.arm_second, 0);
    EXPECT_LT(hit.normal_velocity, 0);
  }
  const auto totals = run.simulation().wall_totals();
  ASSERT_EQ(totals.size(), 3u);
  const int axes[] = {2, 2, 0};
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(totals[n].axis, axes[n]);
    EXPECT_EQ(totals[n].high, n == 1);
    EXPECT_EQ(totals[n].hits, hits[n]);
    EXPECT_GT(hits[n], 5u);
    EXPECT_EQ(totals[n].impulse, static_cast<double>(impulse[n]));
  }
  const std::uint64_t of_pairs = run.simulation().collisions();
  EXPECT_EQ(collisions, of_pairs);
  EXPECT_EQ(seen.size(), of_pairs + hits[0] + hits[1] + hits[2]);

  const io::Contents contents(file);
  const auto kinds = contents.numbers("/events/kind");
  const auto pairs = contents.numbers("/events/pair");
  const auto arms = contents.numbers("/events/arms");
  const auto speeds = contents.numbers("/events/normal_velocity");
  ASSERT_EQ(kinds.size(), seen.size());
  for (std::size_t n = 0; n < seen.size(); ++n) {
    EXPECT_EQ(kinds[n], seen[n].kind);
    EXPECT_EQ(pairs[2 * n], seen[n].event.first);
    EXPECT_EQ(pairs[2 * n + 1], seen[n].event.second);
    EXPECT_EQ(arms[2 * n], seen[n].event.arm_first);
    EXPECT_EQ(speeds[n], seen[n].event.normal_velocity);
  }
  // The last row of the series is of the end.
  const auto counted = contents.numbers("/series/walls/hits/value");
  const auto summed = contents.numbers("/series/walls/impulse/value");
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(counted[counted.size() - 3 + n], hits[n]);
    EXPECT_EQ(summed[summed.size() - 3 + n], totals[n].impulse);
  }
  const auto recorded = io::read_run(file).walls;
  ASSERT_EQ(recorded.size(), 3u);
  EXPECT_EQ(recorded[2].axis, 0);
  EXPECT_EQ(recorded[1].hits, hits[1]);
  EXPECT_EQ(contents.numbers("/series/collisions/value").back(), of_pairs);
  // Observables of collisions are of pairs: a hit has no partner and no angle.
  double sum = 0;  // each row counts since the one before
  for (const double n : contents.numbers("/series/collision_statistics/collisions/value")) sum += n;
  EXPECT_EQ(sum, static_cast<double>(of_pairs));
}

// At each sample, and the pressure is that of the impulses between samples.
TEST_F(WallsOutput, BudgetAndPressureAreThoseOfTheReports) {
  Scene scene = walled(file);
  scene.driving.kicks = {.every = 0.2, .translational = 1, .rotational = 1};
  scene.walls[1].temperature = 2;  // tangential impulses, and normal ones of either sign
  scene.output.observables.clear();
  PreparedRun run(complete_scene(scene), false);
  std::vector<std::vector<double>> impulses(3, std::vector<double>(7));  // by wall and sample
  run.on_happenings(1, [&](auto batch) {
    for (const Happening& h : batch) {
      if (h.is_collision()) continue;
      const auto sample = static_cast<std::size_t>(std::ceil(h.event.time / 0.5));
      const double sign = h.event.second == 1 ? -1 : 1;
      impulses.at(h.event.second).at(sample) += sign * h.event.impulse[h.event.second == 2 ? 0 : 2];
    }
  });
  finish(run);
  const io::Contents contents(file);
  const auto energy = contents.numbers("/series/energy/value");
  const auto time = contents.numbers("/series/time");
  const auto pairs = contents.numbers("/series/energy_budget/pairs/value");
  const auto walls = contents.numbers("/series/energy_budget/walls/value");
  const auto kicks = contents.numbers("/series/energy_budget/kicks/value");
  const auto callers = contents.numbers("/series/energy_budget/velocities_set/value");
  const auto pressure = contents.numbers("/series/walls/pressure/value");
  ASSERT_EQ(energy.size(), 7u);
  EXPECT_FALSE(contents.has("/series/energy_budget/thermostat"));
  EXPECT_FALSE(contents.has("/series/walls/phase"));
  for (std::size_t n = 0; n < energy.size(); ++n) {
    const double sum =
        pairs[n] + kicks[n] + callers[n] + walls[3 * n] + walls[3 * n + 1] + walls[3 * n + 2];
    EXPECT_NEAR(sum, energy[n] - energy[0], 1e-12);
    EXPECT_EQ(time[n], 0.5 * static_cast<double>(n));
    for (std::size_t wall = 0; wall < 3; ++wall) {
      const double found = pressure[3 * n + wall];
      if (n == 0) {
        EXPECT_TRUE(std::isnan(found));
      } else {
        EXPECT_NEAR(found, impulses[wall][n] / (25 * 0.5), 1e-12) << n << ", wall " << wall;
      }
    }
  }
  EXPECT_LT(pairs.back(), -0.01);
  EXPECT_GT(kicks.back(), 0.5);
}

TEST_F(WallsOutput, GoesOnFromACheckpoint) {
  const std::string whole = folder.path() / "whole.h5", parts = folder.path() / "parts.h5";
  PreparedRun undisturbed(complete_scene(walled(whole)), false);
  finish(undisturbed);
  {
    PreparedRun first(complete_scene(walled(parts)), false);
    first.advance(test::until_time(1.7), monitor);
    first.close();
  }
  PreparedRun second(load_checkpoint(parts).checkpoint);
  finish(second);
  EXPECT_EQ(second.simulation().trajectory_hash(), undisturbed.simulation().trajectory_hash());
  const auto a = second.simulation().wall_totals(), b = undisturbed.simulation().wall_totals();
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(a[n].hits, b[n].hits);
    EXPECT_EQ(a[n].impulse, b[n].impulse);
  }
  const io::Contents one(whole), two(parts);
  for (const char* name :
       {"/events/kind", "/events/time", "/events/pair", "/series/walls/hits/value",
        "/series/walls/impulse/value", "/series/walls/pressure/value",
        "/series/energy_budget/pairs/value", "/series/energy_budget/walls/value",
        "/series/wall_profiles/density/value", "/series/wall_profiles/p2/value",
        "/series/centre_of_mass/position/value"}) {
    const std::vector<double> a = one.numbers(name), b = two.numbers(name);
    ASSERT_EQ(a.size(), b.size()) << name;
    EXPECT_GT(a.size(), 3u);
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_TRUE(a[n] == b[n] || (std::isnan(a[n]) && std::isnan(b[n]))) << name << ", " << n;
    }
  }
}

// Heights count from the low edges, and gravity may point to a high wall.
TEST_F(WallsOutput, GoesOnWhereHeightsMakeTheEnergyNegative) {
  Scene scene = walled(folder.path() / "run.h5");
  scene.forces.gravity[2] = 5;
  PreparedRun first(complete_scene(scene), false);
  EXPECT_LT(first.simulation().initial_energy(), 0);
  first.advance(test::until_time(0.5), monitor);
  first.close();
  PreparedRun second(load_checkpoint(scene.output.file).checkpoint);
  EXPECT_EQ(second.simulation().trajectory_hash(), first.simulation().trajectory_hash());
}

TEST_F(WallsOutput, BoxesAreNotPeriodicAlongWalledAxes) {
  PreparedRun run(complete_scene(walled(file)), false);
  finish(run);
  const io::FrameFile frames(file);
  const State state = frames.read(frames.count() - 1);
  EXPECT_EQ(state.periodic, (std::array{false, true, false}));
  EXPECT_EQ(run.simulation().copy().periodic, state.periodic);
  for (const auto& image : state.image) {
    EXPECT_EQ(image[0], 0);
    EXPECT_EQ(image[2], 0);
  }
  // It can be started from in a scene with these walls, and not without.
  Scene again = walled();
  again.initial.file = file;
  again.needles.count = 0;
  EXPECT_EQ(complete_scene(again).initial->size(), 80u);
  again.walls.pop_back();
  again.forces.gravity = {};
  EXPECT_ANY_THROW(complete_scene(again));
}

}  // namespace
}  // namespace needlework::runs
