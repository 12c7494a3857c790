// What a run writes at its samples: when, and with what beside.
#include <gtest/gtest.h>

#include <cmath>

#include "needlework/h5md.h"
#include "needlework/initial_state.h"
#include "src/runs/prepared_run.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

struct Silent : RunMonitor {
  bool is_due(double) const override { return false; }
  void show(const Progress&) override {}
};

class Series : public testing::Test {
 protected:
  Scene scene() const {
    Scene scene = test::scene_of(40, 5);
    scene.until.time = 1.1;
    scene.output.file = path;
    return scene;
  }
  static void drive(LoadedScene loaded) {
    Silent monitor;
    PreparedRun(std::move(loaded), true, "scene").drive(monitor);
  }
  bool holds(const std::string& text) const {
    return io::describe(path).find(text) != std::string::npos;
  }

  const test::TemporaryFolder folder;
  const std::string path = folder.path() / "run.h5";
};

TEST_F(Series, IsAtTheMultiplesOfAStep) {
  Scene every = scene();
  every.output.series_every = 0.25;
  drive(complete_scene(every));
  std::vector<double> times;
  for (const Totals& sample : io::read_run(path).series) times.push_back(sample.time);
  EXPECT_EQ(times, (std::vector<double>{0, 0.25, 0.5, 0.75, 1, 1.1}));
}

TEST_F(Series, BeginsWhenAGasAtRestIsSetInMotion) {
  Scene resting = scene();
  resting.initial.t_tr = resting.initial.t_rot = 0;
  resting.output.frames_per_decade = 2;
  Silent monitor;
  PreparedRun run(complete_scene(resting), true);
  run.advance({.time = 3}, monitor);
  const State moving = draw_initial_state(scene());
  run.simulation().set_velocities(moving.velocity, moving.angular_velocity);
  run.advance({.time = 11}, monitor);
  run.close();
  std::vector<double> times;
  for (const Totals& sample : io::read_run(path).series) times.push_back(sample.time);
  ASSERT_EQ(times.size(), 8U);  // 0, 10^0.5 to 10^1 by tenths of a decade, and the end
  EXPECT_EQ(times[0], 0);
  EXPECT_NEAR(times[1], std::pow(10, 0.5), 1e-12);
  EXPECT_EQ(times[7], 11);
  EXPECT_EQ(io::FrameFile(path).count(), 4U);
}

TEST_F(Series, HasTheoryBesideItWhereTheStateIsDrawn) {
  drive(complete_scene(scene()));
  EXPECT_TRUE(holds("Kinetic theory"));

  drive(complete_scene(scene(), draw_initial_state(scene())));
  EXPECT_FALSE(holds("Kinetic theory")) << "theory does not know the history of a given state";

  Scene resting = scene();
  resting.initial.t_tr = resting.initial.t_rot = 0;
  drive(complete_scene(resting));
  EXPECT_FALSE(holds("Kinetic theory"));
}

TEST_F(Series, HoldsTheObservablesThatAreNamed) {
  Scene observed = scene();
  observed.output.series_every = 0.25;
  observed.output.observables = {"flow_order", "collision_statistics"};
  drive(complete_scene(observed));
  EXPECT_TRUE(holds("translational/value      float64  [6]")) << io::describe(path);
  EXPECT_TRUE(holds("chains/value             int64    [6][64]")) << io::describe(path);
  EXPECT_FALSE(holds("displacement"));
}

}  // namespace
}  // namespace needlework::runs
