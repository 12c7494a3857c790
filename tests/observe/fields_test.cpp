// Fields and profiles of states whose means are known.
#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

const Vector fields_box{4, 3, 3};

// Two needles in the half of low x, one in the other.
State three_needles() {
  State state = resting(3, fields_box);
  state.position = {{0.5, 1, 1}, {1.5, 2, 2}, {3, 1, 2}};
  state.velocity = {{1, 0, 0}, {3, 2, 0}, {0, -5, 0}};
  state.angular_velocity = {{4, 0, 0}, {0, 0, 0}, {1, 1, 0}};
  return state;
}

TEST(Fields, AreTheMeansOfEachCell) {
  Observed observed(scene_with("fields", 3, fields_box, {2, 1, 1}));
  Values values = observed.sample(three_needles());
  EXPECT_EQ(values["density"], (std::vector{2 / 18.0, 1 / 18.0}));
  EXPECT_EQ(values["flow"], (std::vector<double>{2, 1, 0, 0, -5, 0}));
  EXPECT_EQ(values["spin"], (std::vector<double>{2, 0, 0, 1, 1, 0}));
  EXPECT_EQ(values["thermal_tr"], (std::vector<double>{1, 0}));  // |v - U|^2 = 2 for both
  const double inertia = 1 / 12.0;                               // k = 6
  EXPECT_EQ(values["thermal_rot"], (std::vector<double>{inertia * 4 / 2, 0}));
}

TEST(Fields, OfEmptyCellsAreZero) {
  Observed observed(scene_with("fields", 1, fields_box, {1, 1, 2}));
  State state = resting(1, fields_box);
  state.velocity[0] = {7, 0, 0};
  Values values = observed.sample(state);
  EXPECT_EQ(values["density"], (std::vector{1 / 18.0, 0.0}));
  EXPECT_EQ(values["flow"], (std::vector<double>{7, 0, 0, 0, 0, 0}));
  EXPECT_EQ(values["thermal_tr"], (std::vector<double>{0, 0}));
}

TEST(Fields, HoldNoNeedlesOutsideTheBox) {
  Scene scene = scene_with("fields", 3, fields_box, {1, 1, 2});
  scene.walls = {{.axis = "z", .side = "low"}};
  scene.forces.gravity[2] = -1;
  State state = resting(3, fields_box);
  state.position = {{1, 1, -0.1}, {1, 1, 2}, {1, 1, 40}};
  state.velocity = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  Values values = Observed(scene).sample(state);
  EXPECT_EQ(values["density"], (std::vector{0.0, 1 / 18.0}));
  EXPECT_EQ(values["flow"], (std::vector<double>{0, 0, 0, 2, 0, 0}));
}

TEST(Fields, FollowMassAndLengthOfTheSpecies) {
  Scene scene = scene_with("fields", 3, fields_box, {2, 1, 1});
  scene.species = {{.name = "a", .count = 3, .length = 0.5, .mass = 3, .k = 2}};
  Values values = Observed(scene).sample(three_needles());
  EXPECT_EQ(values["thermal_tr"][0], 3);
  EXPECT_EQ(values["thermal_rot"][0], 3 * 0.25 / (2 * 2) * 4 / 2);
}

TEST(Profiles, AreTheMeansOfEachSlabAcrossEachAxis) {
  Observed observed(scene_with("profiles", 3, fields_box, {2, 1, 1}));
  Values values = observed.sample(three_needles());
  EXPECT_EQ(values["position"], (std::vector<double>{1, 3, 0.75, 2.25, 0.75, 2.25}));
  EXPECT_EQ(values["density"],
            (std::vector{2 / 18.0, 1 / 18.0, 2 / 18.0, 1 / 18.0, 1 / 18.0, 2 / 18.0}));
  EXPECT_EQ(values["flow"], (std::vector<double>{2, 1, 0, 0, -5, 0,         // across x
                                                 0.5, -2.5, 0, 3, 2, 0,     // across y
                                                 1, 0, 0, 1.5, -1.5, 0}));  // across z
  EXPECT_EQ(values["thermal_tr"][3], 0);
  EXPECT_EQ(values["thermal_tr"][2], (0.25 + 6.25) / 2);
}

TEST(Grid, CoversTheBoxOnce) {
  const Grid grid({1, 2, 3}, {2, 3, 4});
  EXPECT_EQ(grid.size(), 24u);
  EXPECT_EQ(grid.cell_of({0, 0, 0}), 0u);
  EXPECT_EQ(grid.cell_of({0.2, 0.1, 0.8}), 1u) << "z runs fastest";
  EXPECT_EQ(grid.cell_of({0.2, 0.7, 0.1}), 4u);
  EXPECT_EQ(grid.cell_of({0.5, 0, 0}), 12u) << "a border belongs to the cell above";
  EXPECT_EQ(grid.cell_of({1, 2, 3}), 23u) << "as rounding may do";
  EXPECT_DOUBLE_EQ(grid.cell_volume(), 0.25);
}

TEST(Grid, HoldsTwentyNeedlesInACellByDefault) {
  EXPECT_EQ(default_cells({12, 12, 12}, 20000), (std::array{10, 10, 10}));
  EXPECT_EQ(default_cells({10, 20, 40}, 20 * 64), (std::array{2, 4, 8}));
  EXPECT_EQ(default_cells({12, 12, 12}, 0), (std::array{1, 1, 1}));
  EXPECT_EQ(default_cells({1e9, 3, 3}, 4000000000u), (std::array{100, 1, 1}));
}

}  // namespace
}  // namespace needlework::observe
