// What files and results say of bodies that grow, and what starts from such files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/contents.h"
#include "src/runs/checkpoint.h"
#include "src/runs/prepared_run.h"
#include "src/runs/rod_totals.h"
#include "tests/runs/silent.h"
#include "tests/support/contains.h"
#include "tests/support/message_of.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework::runs {
namespace {

class GrowthOutput : public InRunFolder {
 protected:
  // Spheres of two sizes and rods, at a packing fraction of 0.19 at the start.
  Scene mixture() const {
    Scene scene;
    scene.needles.box = {6, 6, 6};
    scene.species = {{.name = "small", .count = 40, .length = 0, .diameter = 0.6},
                     {.name = "large", .count = 20, .length = 0, .mass = 3, .diameter = 1},
                     {.name = "rods", .count = 40, .length = 1, .mass = 2, .diameter = 0.5}};
    scene.needles.count = 100;
    return growing(std::move(scene));
  }
  Scene growing(Scene scene) const {
    scene.driving.growth = Scene::Growth{.rate = 0.05, .until_packing = 0.3};
    scene.until.time = 1e3;
    scene.output.file = file;
    scene.output.series_every = 0.1;
    scene.output.frames_every = 0.5;
    scene.output.observables = {"contact_network", "collision_statistics"};
    return scene;
  }
  Scene spheres() const {
    Scene scene;
    scene.needles.box = {6, 6, 6};
    scene.species = {{.name = "spheres", .count = 80, .length = 0, .diameter = 0.9}};
    scene.needles.count = 80;
    return growing(std::move(scene));
  }
  std::vector<double> series(const std::string& name) const {
    return io::Contents(file).numbers("/series/" + name + "/value");
  }
};

double packing_of(const State& state) {
  double volume = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double length = state.own_bodies.length[i], diameter = state.own_bodies.diameter[i];
    volume += std::numbers::pi * diameter * diameter * (length / 4 + diameter / 6);
  }
  return volume / (state.box[0] * state.box[1] * state.box[2]);
}

TEST_F(GrowthOutput, FramesHavePresentSizes) {
  const Scene scene = mixture();
  PreparedRun run(complete_scene(scene), false);
  EXPECT_EQ(run.drive(monitor).stop, Stop::grown);
  const io::FrameFile frames(file);
  ASSERT_GT(frames.count(), 4u);
  for (std::size_t n = 0; n < frames.count(); ++n) {
    const State state = frames.read(n);
    ASSERT_TRUE(state.scale);
    EXPECT_EQ(*state.scale > 1, n > 0);
    for (std::size_t i = 0; i < state.size(); ++i) {
      const Species& species = scene.species[state.species[i]];
      EXPECT_DOUBLE_EQ(state.own_bodies.length[i], *state.scale * species.length);
      EXPECT_DOUBLE_EQ(state.own_bodies.diameter[i], *state.scale * species.diameter);
      EXPECT_EQ(state.own_bodies.mass[i], species.mass);
      EXPECT_DOUBLE_EQ(state.own_bodies.inertia[i], species.inertia());
    }
    EXPECT_DOUBLE_EQ(state.bodies.diameter[1], *state.scale);
  }
  const State last = frames.read(frames.count() - 1);
  EXPECT_NEAR(packing_of(last), 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(series("growth/scale").back(), *last.scale);
}

TEST_F(GrowthOutput, SeriesAndTotalsHaveThePresentPacking) {
  PreparedRun run(complete_scene(mixture()), false);
  run.drive(monitor);
  const std::vector<double> packing = series("rods/packing_fraction");
  EXPECT_EQ(packing, series("growth/packing_fraction"));
  EXPECT_NEAR(packing.back(), 0.3, 1e-12);
  EXPECT_LT(packing.front(), 0.2);
  EXPECT_TRUE(std::ranges::is_sorted(packing));
  EXPECT_EQ(rod_totals(run.scene(), run.simulation()).packing_fraction, packing.back());
  const std::vector<double> scale = series("growth/scale"), rate = series("growth/rate"),
                            time = io::Contents(file).numbers("/series/time");
  for (std::size_t n = 0; n < scale.size(); ++n)
    EXPECT_NEAR(scale[n], 1 + rate[0] * time[n], 1e-12);
  EXPECT_TRUE(std::isnan(series("growth/pressure").front()));
  EXPECT_GT(series("growth/pressure").back(), 2);
  for (const double gap : series("contact_network/gap")) EXPECT_EQ(gap, 0.01);
  EXPECT_GT(series("contact_network/rattlers").back(), 50);
  // Contacts of rods are on them, however long they have become.
  const std::vector<double> arms = series("collision_statistics/arms"),
                            collisions = series("collision_statistics/collisions");
  double all_arms = 0, all_collisions = 0;
  for (const double count : arms) all_arms += count;
  for (const double count : collisions) all_collisions += count;
  EXPECT_EQ(all_arms, 2 * all_collisions);
}

// Of one size, so that the bodies of the other scene are of one species without sizes.
TEST_F(GrowthOutput, IsTheStartOfAnotherScene) {
  PreparedRun run(complete_scene(spheres()), false);
  run.drive(monitor);
  const double scale = run.simulation().growth()->scale;
  run.close();
  Scene other;
  other.initial.file = file;
  other.until.collisions_per_needle = 20;
  const LoadedScene loaded = complete_scene(other);
  EXPECT_TRUE(loaded.initial->own_bodies.empty());
  EXPECT_FALSE(loaded.scene.composition().has_own_sizes());
  EXPECT_DOUBLE_EQ(loaded.scene.composition()[0].diameter, 0.9 * scale);
  EXPECT_NEAR(loaded.scene.composition().packing_fraction(216), 0.3, 1e-12);
  Simulation simulation(loaded.scene, *loaded.initial);
  simulation.advance(loaded.scene.until);
  EXPECT_GE(simulation.collisions(), 800u);

  other.driving.growth = Scene::Growth{.rate = 0.05, .until_packing = 0.2};
  const LoadedScene late = complete_scene(other);
  const std::string said =
      test::message_of<InputError>([&] { Simulation(late.scene, *late.initial); });
  EXPECT_TRUE(test::contains(said, "expected more than the packing fraction at the start")) << said;

  // On from there.
  other.driving.growth = Scene::Growth{.rate = 0.05, .until_packing = 0.4};
  const LoadedScene more = complete_scene(other);
  Simulation second(more.scene, *more.initial);
  other.until = {.time = 1e3};
  EXPECT_EQ(second.advance(other.until), Stop::grown);
  EXPECT_NEAR(second.growth()->packing_fraction, 0.4, 1e-12);
}

TEST_F(GrowthOutput, OfSeveralSpeciesStartsAnotherScene) {
  PreparedRun run(complete_scene(mixture()), false);
  run.drive(monitor);
  const double scale = run.simulation().growth()->scale;
  run.close();
  Scene other;
  other.initial.file = file;
  other.until.collisions_per_needle = 20;
  const LoadedScene loaded = complete_scene(other);
  const Composition composition = loaded.scene.composition();
  EXPECT_FALSE(composition.has_own_sizes());
  EXPECT_DOUBLE_EQ(composition[2].length, scale);
  EXPECT_DOUBLE_EQ(composition[2].inertia(), mixture().species[2].inertia());
  Simulation simulation(loaded.scene, *loaded.initial);
  simulation.advance(loaded.scene.until);
  EXPECT_GE(simulation.collisions(), 1000u);
}

TEST_F(GrowthOutput, OtherSizesAreRefused) {
  PreparedRun run(complete_scene(spheres()), false);
  run.drive(monitor);
  run.close();
  Scene other;
  other.initial.file = file;
  other.until.collisions_per_needle = 20;
  other.species = {{.name = "spheres", .length = 0, .diameter = 0.9}};
  const std::string said = test::message_of<InputError>([&] { complete_scene(other); });
  EXPECT_TRUE(test::contains(said, "diameter = 0.9"));
  EXPECT_TRUE(test::contains(said, "as in "));
}

// Where each body has sizes of its own, they grow in proportion.
TEST_F(GrowthOutput, KeepsRatiosOfSizes) {
  Scene scene = spheres();
  scene.species[0].drawn.diameter =
      Distribution{.shape = Distribution::Shape::uniform, .mean = 0.9, .width = 0.1};
  PreparedRun run(complete_scene(scene), false);
  run.drive(monitor);
  const io::FrameFile frames(file);
  const State first = frames.read(0), last = frames.read(frames.count() - 1);
  EXPECT_NE(first.own_bodies.diameter[0], first.own_bodies.diameter[1]);
  for (std::size_t i = 0; i < first.size(); ++i)
    EXPECT_DOUBLE_EQ(last.own_bodies.diameter[i], *last.scale * first.own_bodies.diameter[i]);
  EXPECT_NEAR(packing_of(last), 0.3, 1e-12);
  const State now = run.simulation().copy();
  EXPECT_DOUBLE_EQ(now.own_bodies.diameter[7], last.own_bodies.diameter[7]);
}

// All that a run writes, wherever it is cut, and on one thread or two.
TEST_F(GrowthOutput, GoesOnFromItsCheckpoints) {
  Scene scene = mixture();
  scene.species[0].drawn.diameter =
      Distribution{.shape = Distribution::Shape::uniform, .mean = 0.6, .width = 0.1};
  const auto written = [&] {
    std::vector<std::vector<double>> all;
    for (const char* name :
         {"growth/scale", "growth/pressure", "growth/packing_fraction", "rods/packing_fraction",
          "contact_network/contacts", "contact_network/rattlers", "collision_statistics/arms",
          "energy", "energy_budget/growth", "energy_budget/cooling"})
      all.push_back(series(name));
    const io::FrameFile frames(file);
    for (std::size_t n = 0; n < frames.count(); ++n) {
      const State state = frames.read(n);
      all.push_back({*state.scale});
      for (const auto& r : state.position) all.emplace_back(r.begin(), r.end());
    }
    for (auto& row : all)
      for (double& x : row) x = std::isnan(x) ? -1 : x;
    return all;
  };
  const RunResult whole = PreparedRun(complete_scene(scene), true).drive(monitor);
  const auto expected = written();
  for (const int threads : {1, 2}) {
    scene = test::on_threads(scene, threads);
    for (const double share : threads == 1 ? std::vector{0.0, 0.1, 0.93} : std::vector{0.45}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, " + std::to_string(share));
      scene.until.time = share * whole.last.time;
      PreparedRun(complete_scene(scene), true, "scene").drive(monitor);
      RunCheckpoint saved = CheckpointFiles(file).latest().checkpoint;
      saved.scene.until.time = 1e3;
      const RunResult rest = PreparedRun(std::move(saved)).drive(monitor);
      EXPECT_EQ(rest.stop, Stop::grown);
      EXPECT_EQ(rest.last.collisions, whole.last.collisions);
      // The end of the first part is a sample and a frame of it alone.
      EXPECT_TRUE(written() == expected);
    }
  }
}

}  // namespace
}  // namespace needlework::runs
