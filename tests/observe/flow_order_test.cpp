// Order of the flow, and temperatures by axis, where they are known.
#include <cmath>
#include <limits>

#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

const Vector flow_box{4, 4, 4};

// One needle in the middle of each of 2 x 2 x 2 cells.
State lattice() {
  State state = resting(8, flow_box);
  for (std::size_t i = 0; i < 8; ++i) {
    state.position[i] = {i & 1 ? 3.0 : 1.0, i & 2 ? 3.0 : 1.0, i & 4 ? 3.0 : 1.0};
  }
  return state;
}

TEST(FlowOrder, IsInfiniteForAUniformFlow) {
  State state = lattice();
  std::fill(state.velocity.begin(), state.velocity.end(), Vector{1, 0, 0});
  Values values = Observed(scene_with("flow_order", 8, flow_box)).sample(state);
  EXPECT_EQ(values["translational"][0], std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(values["rotational"][0])) << "nothing rotates";
  EXPECT_EQ(values["second_moment"][0], 0);
}

TEST(FlowOrder, IsInfiniteForARigidRotation) {
  State state = lattice();
  for (std::size_t i = 0; i < 8; ++i) {  // about the axis x = y = 2
    state.velocity[i] = {-(state.position[i][1] - 2), state.position[i][0] - 2, 0};
    state.angular_velocity[i] = {0.5, 0, 0};
  }
  Values values = Observed(scene_with("flow_order", 8, flow_box, {2, 2, 2})).sample(state);
  EXPECT_EQ(values["translational"][0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(values["rotational"][0], std::numeric_limits<double>::infinity());
  // The same rotation is no flow in one cell.
  EXPECT_EQ(Observed(scene_with("flow_order", 8, flow_box)).sample(state)["translational"][0], 0);
}

TEST(FlowOrder, ComparesFlowWithThermalMotion) {
  State state = lattice();  // low and high half in z: U = (2, 0, 0) and 0
  for (std::size_t i = 0; i < 8; ++i) {
    state.velocity[i] = {i & 4 ? 0.0 : 2.0, i & 1 ? 1.0 : -1.0, 0};
    state.angular_velocity[i] = {i & 4 ? 3.0 : 1.0, i & 1 ? 1.0 : -1.0, 0};
  }
  Values values = Observed(scene_with("flow_order", 8, flow_box, {1, 1, 2})).sample(state);
  EXPECT_EQ(values["translational"][0], 2.0);  // <U^2> = 4 / 2, <|v - U|^2> = 1
  EXPECT_EQ(values["rotational"][0], 5.0);
}

TEST(FlowOrder, MeasuresTheVarianceOfTheDensity) {
  State state = lattice();
  state.position[0] = state.position[7];  // 0, 2, and six times 1
  Values values = Observed(scene_with("flow_order", 8, flow_box, {2, 2, 2})).sample(state);
  EXPECT_EQ(values["second_moment"][0], 0.25);
}

// Flow is the sum over C cells of 3 squares of Gaussian components, 2 of them for the spin.
TEST(FlowOrder, IsOneNineteenthForRandomVelocitiesAtTwentyPerCell) {
  const std::size_t count = 20000;
  const double cells = 1000;
  Scene scene = test::scene_of(count, 12, 3);
  scene.output.observables = {"flow_order"};  // the default grid
  Values values = Observed(scene).sample(draw_initial_state(scene));
  const double expected = cells / (count - cells);
  EXPECT_NEAR(expected, 1 / 19.0, 1e-15);
  EXPECT_NEAR(values["translational"][0], expected, 4 * expected * std::sqrt(2 / (3 * cells)));
  EXPECT_NEAR(values["rotational"][0], expected, 4 * expected * std::sqrt(2 / (2 * cells)));
  const double poisson = (cells - 1) / count;
  EXPECT_NEAR(values["second_moment"][0], poisson, 4 * poisson * std::sqrt(2 / cells));
}

TEST(TemperatureByAxis, IsThatOfTheComponents) {
  State state = lattice();
  for (std::size_t i = 0; i < 8; ++i) {
    state.velocity[i] = {0, 1, 2};
    state.angular_velocity[i] = {6, 0, 0};
  }
  Values values = Observed(scene_with("temperature_by_axis", 8, flow_box)).sample(state);
  EXPECT_EQ(values["t_tr"], (std::vector<double>{0, 1, 4}));
  EXPECT_EQ(values["t_rot"], (std::vector{1.5 * (1 / 12.0) * 36, 0.0, 0.0}));
  EXPECT_DOUBLE_EQ(sum(values["t_rot"]) / 3, totals_of(state, 1 / 12.0).t_rot);
}

}  // namespace
}  // namespace needlework::observe
