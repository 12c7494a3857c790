// The end of a run is predicted from what this process has done, and drifts are measured.
#include "src/runs/pace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/runs.h"

namespace needlework::runs {
namespace {

using test::until_collisions;

TEST(Pace, OfARunThatIsContinuedIsThatOfThisProcess) {
  const Scene scene = test::scene_of(50, 5);
  Simulation simulation(scene);
  const Totals initial = simulation.totals();
  simulation.advance(until_collisions(5));
  const Pace pace(simulation, scene, until_collisions(10), initial);
  EXPECT_TRUE(std::isinf(pace.after(1).left)) << "nothing is known yet";
  simulation.advance(until_collisions(7.5));
  const Progress progress = pace.after(4);
  const auto done = static_cast<double>(progress.now.collisions);
  EXPECT_NEAR(progress.fraction, 0.75, 0.01);
  EXPECT_NEAR(progress.left, 4, 0.1);
  EXPECT_EQ(progress.rate, (done - 125) / 4);
}

TEST(Pace, MeasuresTheDriftOfMomentum) {
  Scene scene = test::scene_of(50, 5);
  scene.species = {{.name = "heavy", .count = 50, .mass = 4}};
  Simulation simulation(scene);
  const Totals initial = simulation.totals();
  const Pace pace(simulation, scene, until_collisions(10), initial);
  simulation.advance(until_collisions(10));
  EXPECT_LT(pace.after(1).momentum_drift, 1e-13);
  // All needles 0.3 faster along x: P grows by N m 0.3.
  const State state = simulation.copy();
  auto velocity = state.velocity;
  for (auto& v : velocity) v[0] += 0.3;
  simulation.set_velocities(velocity, state.angular_velocity);
  const double t_tr = simulation.totals().t_tr;
  EXPECT_NEAR(pace.after(1).momentum_drift, 50 * 4 * 0.3 / std::sqrt(50 * 4 * t_tr), 1e-9);
}

}  // namespace
}  // namespace needlework::runs
