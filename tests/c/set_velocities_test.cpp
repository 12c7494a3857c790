// Velocities replaced by a C program.
#include <algorithm>
#include <limits>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::Arrays;
using test::cooling;
using test::CSimulation;

struct Velocities {
  explicit Velocities(const Arrays& arrays)
      : v{arrays.velocity.data(), 0, 0}, w{arrays.angular_velocity.data(), 0, 0} {}
  needlework_const_vectors v, w;
};

TEST(CSetVelocities, ReplacesThemAndNothingElse) {
  const CSimulation simulation(cooling);
  simulation.run_to(50);
  const std::string hash = simulation.hash();
  const needlework_totals before = simulation.totals();
  Arrays arrays(simulation);
  for (double& x : arrays.velocity) x *= 2;
  for (double& x : arrays.angular_velocity) x *= 2;
  const Velocities velocities(arrays);
  EXPECT_EQ(needlework_set_velocities(simulation, &velocities.v, &velocities.w), NEEDLEWORK_OK);
  EXPECT_EQ(Arrays(simulation).velocity, arrays.velocity);
  EXPECT_EQ(Arrays(simulation).position, arrays.position);
  const needlework_totals after = simulation.totals();
  EXPECT_NEAR(after.energy, 4 * before.energy, 1e-12);
  EXPECT_EQ(after.initial_energy, before.initial_energy);
  EXPECT_EQ(after.collisions, 50u);
  EXPECT_EQ(after.time, before.time);
  EXPECT_EQ(simulation.hash(), hash);
  simulation.run_to(100);
}

TEST(CSetVelocities, StopsAllRotationWithAWordWhereNoneIsGiven) {
  const CSimulation simulation(cooling);
  const Arrays arrays(simulation);
  const Velocities velocities(arrays);
  EXPECT_EQ(needlework_set_velocities(simulation, &velocities.v, nullptr), NEEDLEWORK_OK);
  EXPECT_EQ(simulation.message(), "angular_velocity: not given: those of all needles are 0 now");
  EXPECT_EQ(simulation.totals().t_rot, 0);
  EXPECT_EQ(Arrays(simulation).velocity, arrays.velocity);
}

TEST(CSetVelocities, TakesAnyLayout) {
  const CSimulation rows(cooling), columns(cooling);
  Arrays arrays(rows);
  std::reverse(arrays.velocity.begin(), arrays.velocity.end());
  std::vector<double> v(180), w(180);
  for (std::size_t n = 0; n < 60; ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      v[n + 60 * axis] = arrays.velocity[3 * n + axis];
      w[n + 60 * axis] = arrays.angular_velocity[3 * n + axis];
    }
  }
  const Velocities by_rows(arrays);
  const needlework_const_vectors v_columns{v.data(), 1, 60}, w_columns{w.data(), 1, 60};
  EXPECT_EQ(needlework_set_velocities(rows, &by_rows.v, &by_rows.w), NEEDLEWORK_OK);
  EXPECT_EQ(needlework_set_velocities(columns, &v_columns, &w_columns), NEEDLEWORK_OK);
  rows.run_to(100);
  columns.run_to(100);
  EXPECT_EQ(rows.hash(), columns.hash());
}

TEST(CSetVelocities, RefusesWhatIsNoNumberAndChangesNothing) {
  const CSimulation simulation(cooling);
  simulation.run_to(50);
  const Arrays before(simulation);
  Arrays arrays = before;
  arrays.velocity[3 * 7 + 2] = std::numeric_limits<double>::quiet_NaN();
  const Velocities velocities(arrays);
  EXPECT_EQ(needlework_set_velocities(simulation, &velocities.v, &velocities.w), NEEDLEWORK_INPUT);
  const std::string message = simulation.message();
  EXPECT_TRUE(message.starts_with("set_velocities: row 7 of velocity = (") &&
              message.ends_with(", nan): expected finite numbers, their squares too"))
      << message;
  EXPECT_EQ(Arrays(simulation).velocity, before.velocity);
  EXPECT_EQ(Arrays(simulation).angular_velocity, before.angular_velocity);
}

}  // namespace
}  // namespace needlework
