// What a run writes at its samples: when, and with what beside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "needlework/h5md.h"
#include "needlework/initial_state.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/prepared_run.h"
#include "tests/runs/silent.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace needlework::runs {
namespace {

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

TEST_F(Series, HasFramesAtTheMultiplesOfAStep) {
  Scene every = scene();
  every.output.frames_every = 0.5;
  drive(complete_scene(every));
  EXPECT_TRUE(holds("4 frames")) << io::describe(path);  // 0, 0.5, 1, 1.1
}

TEST_F(Series, BeginsWhenAGasAtRestIsSetInMotion) {
  const State moving = draw_initial_state(scene());
  Silent monitor;
  // Begun at rest, set in motion at time 3, and continued from a checkpoint in between or not.
  const auto sampled = [&](const Scene::Output& output, bool continued) {
    Scene resting = scene();
    resting.initial.t_tr = resting.initial.t_rot = 0;
    resting.output = output;
    auto run = std::make_unique<PreparedRun>(complete_scene(resting), true);
    run->advance(test::until_time(3), monitor);
    run->simulation().set_velocities(moving.velocity, moving.angular_velocity);
    if (continued) {
      run->save_checkpoint();
      run.reset();
      run = std::make_unique<PreparedRun>(load_checkpoint(path).checkpoint);
    }
    run->advance(test::until_time(11), monitor);
    run->close();
    std::vector<double> times;
    for (const Totals& sample : io::read_run(path).series) times.push_back(sample.time);
    return std::pair(times, io::FrameFile(path).count());
  };
  const auto is_near = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) < 1e-12; });
  };
  for (const bool continued : {false, true}) {
    Scene::Output output = scene().output;
    output.frames_per_decade = 2;
    auto [times, frames] = sampled(output, continued);
    std::vector<double> expected{0};
    for (int n = 5; n <= 10; ++n) expected.push_back(std::pow(10, n / 10.0));
    expected.push_back(11);
    EXPECT_TRUE(is_near(times, expected)) << testing::PrintToString(times);
    EXPECT_EQ(frames, 4U);
    output = scene().output;
    output.series_every = 3;
    output.frame_times = {0, 3, 5};
    std::tie(times, frames) = sampled(output, continued);
    EXPECT_EQ(times, (std::vector<double>{0, 3, 6, 9, 11}));
    EXPECT_EQ(frames, 4U);
  }
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
