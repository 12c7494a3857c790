// Uniform shear in C: the pressure tensor and the energy by the flow.
#include <cmath>
#include <vector>

#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::CSimulation;

TEST(CShear, HasAPressureTensor) {
  const CSimulation gas(
      "needles = { count = 60, box = 4 }\ncollisions.epsilon = 0.9\nshear.rate = 1.5\n");
  gas.run_to(300);
  needlework_pressure_tensor tensor{};
  EXPECT_EQ(needlework_get_pressure_tensor(gas, &tensor), NEEDLEWORK_OK) << gas.error.message;
  EXPECT_EQ(tensor.kinetic_xy, tensor.kinetic_yx);
  EXPECT_NEAR(tensor.collisional_xx + tensor.collisional_yy + tensor.collisional_zz, 0, 1e-12);
  EXPECT_EQ(tensor.viscosity, tensor.shear_stress / 1.5);
  needlework_energy_budget budget{};
  EXPECT_EQ(needlework_get_energy_budget(gas, &budget), NEEDLEWORK_OK);
  EXPECT_NE(budget.shear, 0);
  EXPECT_EQ(needlework_get_pressure_tensor(gas, nullptr), NEEDLEWORK_USAGE);
}

TEST(CShear, TakesAndGivesVelocitiesBesideTheFlow) {
  const char* const scene = "needles = { count = 60, box = 4 }\nshear.rate = 1.5\n";
  const CSimulation gas(scene);
  gas.run_to(30);
  std::vector<double> rows[5];
  for (auto& each : rows) each.resize(3 * 60);
  double slide = 0;
  needlework_state state{};
  state.position = {rows[0].data(), 3, 1};
  state.velocity = {rows[1].data(), 3, 1};
  state.orientation = {rows[2].data(), 3, 1};
  state.angular_velocity = {rows[3].data(), 3, 1};
  state.peculiar_velocity = {rows[4].data(), 3, 1};
  state.slide = &slide;
  ASSERT_EQ(needlework_get_state(gas, &state), NEEDLEWORK_OK) << gas.error.message;
  EXPECT_GT(slide, 0);
  for (std::size_t n = 0; n < 60; ++n)
    EXPECT_NEAR(rows[1][3 * n] - 1.5 * rows[0][3 * n + 1], rows[4][3 * n], 1e-12);
  needlework_initial initial{};
  initial.count = 60;
  initial.position = {rows[0].data(), 3, 1};
  initial.orientation = {rows[2].data(), 3, 1};
  initial.angular_velocity = {rows[3].data(), 3, 1};
  initial.peculiar_velocity = {rows[4].data(), 3, 1};
  initial.slide = slide;
  needlework_error error{};
  needlework_simulation* again =
      needlework_create_from("needles.box = 4\nshear.rate = 1.5\n", &initial, 0, &error);
  ASSERT_TRUE(again) << error.message;
  std::vector<double> velocity(3 * 60);
  needlework_state copy{};
  copy.velocity = {velocity.data(), 3, 1};
  EXPECT_EQ(needlework_get_state(again, &copy), NEEDLEWORK_OK);
  for (std::size_t n = 0; n < velocity.size(); ++n) EXPECT_NEAR(velocity[n], rows[1][n], 1e-12);
  needlework_destroy(again);
  initial.velocity = {rows[1].data(), 3, 1};
  EXPECT_FALSE(needlework_create_from("needles.box = 4\nshear.rate = 1.5\n", &initial, 0, &error));
  EXPECT_EQ(error.code, NEEDLEWORK_USAGE);
}

TEST(CShear, HasNoTensorThatNobodyAskedFor) {
  const CSimulation gas("needles = { count = 60, box = 4 }\n");
  gas.run_to(10);
  needlework_pressure_tensor tensor{};
  EXPECT_EQ(needlework_get_pressure_tensor(gas, &tensor), NEEDLEWORK_OK);
  EXPECT_TRUE(std::isnan(tensor.kinetic_xx));
  EXPECT_TRUE(std::isnan(tensor.viscosity_error));
}

}  // namespace
}  // namespace needlework
