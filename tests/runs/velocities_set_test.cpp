// Velocities replaced by a caller: what the file says of it, and what it says no more.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/contents.h"
#include "src/runs/load_checkpoint.h"
#include "src/runs/prepared_run.h"
#include "tests/runs/silent.h"
#include "tests/support/runs.h"

namespace needlework::runs {
namespace {

using VelocitiesSet = InRunFolder;

Scene sampled_scene(const std::string& file) {
  Scene scene = test::scene_of(60, 5);
  scene.collisions.epsilon = 0.9;
  scene.output.file = file;
  scene.output.series_every = 1;
  scene.output.frame_times = {2};
  return scene;
}

void run_to(PreparedRun& run, double time) {
  Silent monitor;
  run.advance(test::until_time(time), monitor);
}

// Doubles all velocities, which takes the energy to four times what it was.
void heat(PreparedRun& run) {
  State state = run.simulation().copy();
  for (auto* rows : {&state.velocity, &state.angular_velocity}) {
    for (auto& row : *rows) {
      for (double& x : row) x *= 2;
    }
  }
  run.set_velocities(state.velocity, state.angular_velocity);
}

std::size_t rows_at(const std::vector<double>& times, double time) {
  return static_cast<std::size_t>(std::count(times.begin(), times.end(), time));
}

TEST_F(VelocitiesSet, AreRecordedWithTheEnergyBeforeAndAfter) {
  PreparedRun run(complete_scene(sampled_scene(file)), false);
  EXPECT_FALSE(run.velocities_set());
  run_to(run, 1.5);
  const Totals before = run.simulation().totals();
  heat(run);
  EXPECT_EQ(run.velocities_set(), 1.5);
  run_to(run, 2.5);
  heat(run);
  EXPECT_EQ(run.velocities_set(), 1.5);
  run.close();
  const io::Contents contents(file);
  EXPECT_EQ(contents.numbers("/velocities_set/time"), (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(contents.numbers("/velocities_set/step").front(),
            static_cast<double>(before.collisions));
  const std::vector<double> energy = contents.numbers("/velocities_set/energy");
  ASSERT_EQ(energy.size(), 4u);
  EXPECT_EQ(energy[0], before.energy);
  EXPECT_NEAR(energy[1], 4 * before.energy, 1e-12 * energy[1]);
  EXPECT_EQ(contents.shape("/velocities_set/momentum"), (std::vector<std::size_t>{2, 2, 3}));
}

TEST_F(VelocitiesSet, LeaveTheoryOutFromThenOn) {
  {
    PreparedRun run(complete_scene(sampled_scene(file)), false);
    run_to(run, 2.5);
    heat(run);
    run_to(run, 3.5);
    run.close();
  }
  PreparedRun run(load_checkpoint(file).checkpoint);
  EXPECT_EQ(run.velocities_set(), 2.5);
  run_to(run, 5.5);
  run.close();
  const io::Contents contents(file);
  const std::vector<double> theory = contents.numbers("/series/theory/energy");
  const std::vector<double> times = contents.numbers("/series/time");
  ASSERT_EQ(theory.size(), times.size());
  for (std::size_t n = 0; n < times.size(); ++n) {
    EXPECT_EQ(std::isnan(theory[n]), times[n] > 2.5) << times[n];
  }
}

TEST_F(VelocitiesSet, AreInASampleAndAFrameOfThatInstant) {
  PreparedRun run(complete_scene(sampled_scene(file)), false);
  run_to(run, 2);  // when both are due
  heat(run);
  const double after = run.simulation().totals().energy;
  run_to(run, 2.5);
  run.close();
  const io::Contents contents(file);
  const std::vector<double> times = contents.numbers("/series/time");
  ASSERT_EQ(rows_at(times, 2), 1u);
  EXPECT_EQ(contents.numbers("/series/energy")[2], after);
  EXPECT_EQ(rows_at(contents.numbers("/particles/needles/position/time"), 2), 1u);
  EXPECT_EQ(contents.numbers("/observables/energy")[1], after);
}

TEST_F(VelocitiesSet, LeaveASampleBeforeThemIfItIsTaken) {
  PreparedRun run(complete_scene(sampled_scene(file)), false);
  run_to(run, 2);
  const double before = run.simulation().totals().energy;
  run.sample(true);
  run.sample(true);  // of the same state
  heat(run);
  const double after = run.simulation().totals().energy;
  run_to(run, 2.5);
  run.close();
  const io::Contents contents(file);
  const std::vector<double> times = contents.numbers("/series/time");
  ASSERT_EQ(rows_at(times, 2), 2u);
  const std::vector<double> energy = contents.numbers("/series/energy");
  EXPECT_EQ(energy[2], before);
  EXPECT_EQ(energy[3], after);
  EXPECT_EQ(rows_at(contents.numbers("/particles/needles/position/time"), 2), 2u);
}

TEST_F(VelocitiesSet, AreInTheSampleOfTheEnd) {
  PreparedRun run(complete_scene(sampled_scene(file)), false);
  run_to(run, 1.5);
  run.sample(false);
  heat(run);
  const double after = run.simulation().totals().energy;
  run.close();
  EXPECT_EQ(io::read_run(file).series.back().energy, after);
  heat(run);  // which nothing records any more
  EXPECT_THROW(run.sample(false), InputError);
}

}  // namespace
}  // namespace needlework::runs
