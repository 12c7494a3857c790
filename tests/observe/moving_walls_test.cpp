// Observables where walls with a velocity move edges of the box, of states made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "src/observe/pressure.h"
#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

constexpr double later = 2;

Scene::Wall moving(const std::string& side, double velocity,
                   const std::optional<double>& stop_at = {}) {
  return {.axis = "z",
          .side = side,
          .motion = Scene::WallMotion{.velocity = velocity, .stop_at = stop_at}};
}

// Of edges 4, 3 and 8. At time 2 the one along z is from 2 to 7, and so it stays.
Scene between_pistons(const std::string& observable, std::size_t count,
                      const std::array<int, 3>& cells = {1, 1, 1}) {
  Scene scene = scene_with(observable, count, {4, 3, 8}, cells);
  scene.walls = {moving("low", 1, 2), moving("high", -0.5, 7)};
  return scene;
}

// The same box as the walls have left it, at rest.
Scene between_resting_walls(const std::string& observable, std::size_t count,
                            const std::array<int, 3>& cells = {1, 1, 1}) {
  Scene scene = scene_with(observable, count, {4, 3, 5}, cells);
  scene.walls = {{.axis = "z", .side = "both"}};
  return scene;
}

State at_rest_in(const Vector& edges, const Vector& low, const std::vector<Vector>& positions) {
  State state = resting(positions.size(), edges);
  state.low = low;
  state.periodic = {true, true, false};
  state.position = positions;
  return state;
}

State three_of_them() {
  return at_rest_in({4, 3, 5}, {0, 0, 2}, {{0.5, 1, 3}, {1.5, 2, 5}, {3, 1, 6}});
}

TEST(FieldsBetweenPistons, AreInCellsOfThePresentBox) {
  Observed observed(between_pistons("fields", 3, {1, 1, 2}));
  // Cells from 2 to 4.5 and on to 7, of the volume 4 * 3 * 2.5.
  EXPECT_EQ(observed.sample(three_of_them(), later)["density"], (std::vector{1 / 30.0, 2 / 30.0}));
  State state = three_of_them();
  state.position[0][2] = 1.9;
  EXPECT_EQ(observed.sample(state, later)["density"], (std::vector{0.0, 2 / 30.0}));
  const State start = at_rest_in({4, 3, 8}, {}, {{1, 1, 0.5}, {1, 1, 3.5}, {1, 1, 7.5}});
  EXPECT_EQ(observed.sample(start, 0)["density"], (std::vector{2 / 48.0, 1 / 48.0}));
}

TEST(ProfilesBetweenPistons, SayWhereTheirSlabsAre) {
  Values values =
      Observed(between_pistons("profiles", 3, {1, 1, 2})).sample(three_of_them(), later);
  EXPECT_EQ(values["position"], (std::vector<double>{1, 3, 0.75, 2.25, 3.25, 5.75}));
  const std::vector<double>& density = values["density"];
  EXPECT_EQ(std::vector(density.end() - 2, density.end()), (std::vector{1 / 30.0, 2 / 30.0}));
}

TEST(ObservablesBetweenPistons, AreThoseOfABoxThatIsAsTheyHaveLeftIt) {
  State moved = draw_initial_state(between_resting_walls("fields", 300));
  State shifted = moved;
  for (Vector& position : shifted.position) position[2] += 2;
  shifted.low = {0, 0, 2};
  for (const std::string name : {"fields", "profiles", "flow_order", "distributions",
                                 "pair_correlation", "structure_factor"}) {
    const std::array<int, 3> cells{2, 1, 5};
    Values expected = Observed(between_resting_walls(name, 300, cells)).sample(moved);
    Values found = Observed(between_pistons(name, 300, cells)).sample(shifted, later);
    ASSERT_EQ(found.size(), expected.size()) << name;
    for (const auto& [field, values] : expected) {
      ASSERT_EQ(found[field].size(), values.size()) << name << ' ' << field;
      for (std::size_t n = 0; n < values.size(); ++n) {
        // Of the last axis, after those along which slabs are where they were.
        const bool moves = field == "position" && n >= 2 * values.size() / 3;
        if (std::isnan(values[n])) continue;
        EXPECT_NEAR(found[field][n], values[n] + (moves ? 2 : 0), 1e-9 * (1 + std::abs(values[n])))
            << name << ' ' << field << ' ' << n;
      }
    }
  }
}

// In the order of samples, so that what is known of one box is not taken for that of the next.
TEST(PairCorrelationBetweenPistons, KnowsTheIdealGasOfEachBox) {
  Observed observed(between_pistons("pair_correlation", 2)),
      other(between_pistons("pair_correlation", 2));
  const State start = at_rest_in({4, 3, 8}, {}, {{1, 1, 4}, {1, 1, 4.5}});
  const State end = at_rest_in({4, 3, 5}, {0, 0, 2}, {{1, 1, 4}, {1, 1, 4.5}});
  const double at_start = sum(observed.sample(start, 0)["g"]);
  const double at_end = sum(observed.sample(end, later)["g"]);
  EXPECT_EQ(at_end, sum(other.sample(end, later)["g"]));
  EXPECT_LT(at_end, 0.75 * at_start);  // about 5/8 of the room
}

TEST(WallProfilesBetweenPistons, HaveThePresentAreaOfOtherWalls) {
  Scene scene = between_pistons("wall_profiles", 2, {2, 1, 2});
  scene.walls.push_back({.axis = "x", .side = "both"});
  State state = at_rest_in({4, 3, 5}, {0, 0, 2}, {{1, 1, 3}, {3, 1, 3}});
  state.periodic[0] = false;
  Values values = Observed(scene).sample(state, later);
  // Slabs across x of the volume 2 * 3 * 5; across z, where walls pass, 4 * 3 * 4 at all times.
  EXPECT_EQ(values["density"], (std::vector{1 / 30.0, 1 / 30.0, 2 / 48.0, 0.0}));
  EXPECT_EQ(values["position"], (std::vector<double>{1, 3, 2, 6}));
}

TEST(CentreOfMassBetweenPistons, IsWhereItIs) {
  Observed observed(between_pistons("centre_of_mass", 3));
  EXPECT_NEAR(observed.sample(three_of_them(), later)["position"].at(0), 14 / 3.0, 1e-14);
}

// All of what a scene records at one time, after this impulse on each wall.
std::vector<double> row_of(Observation& observation, const Scene& scene, double time,
                           double impulse) {
  SpeciesSums sums = no_sums(scene);
  const std::vector<Scene::WallSide> sides = scene.wall_sides();
  for (std::size_t n = 0; n < sums.walls.size(); ++n) {
    sums.walls[n].axis = static_cast<int>(sides[n].axis);
    sums.walls[n].normal_impulse = impulse;
  }
  sums.stress.kinetic[0][0] = impulse;
  Totals totals;
  totals.time = time;
  const auto row = observation.sample({}, totals, sums);
  return {row.begin(), row.end()};
}

// Where a dataset of several numbers is in such a row.
std::size_t place_of(const Observation& observation, const std::string& group,
                     const std::string& name) {
  std::size_t place = 0;
  for (const SeriesGroup& each : observation.groups()) {
    for (const SeriesField& field : each.fields) {
      if (each.name == group && field.name == name) return place;
      if (field.kind != SeriesField::Kind::constant) place += field.width();
    }
  }
  ADD_FAILURE() << group << '/' << name << " is no dataset with rows";
  return 0;
}

TEST(WallSumsBetweenPistons, HaveThePressureOnTheMeanArea) {
  Scene scene = between_pistons("fields", 3);
  scene.output.observables.clear();
  scene.walls.push_back({.axis = "x", .side = "low"});
  scene.walls.push_back({.axis = "x", .side = "high"});
  Observation observation(scene);
  const std::size_t place = place_of(observation, "walls", "pressure");
  row_of(observation, scene, 0, 0);
  // Across x the area is 3 times 8 to 6.5 in a time of 1, then to 5 in another, and so it stays.
  EXPECT_DOUBLE_EQ(row_of(observation, scene, 1, 7)[place + 2], 7 / (3 * 7.25));
  const auto second = row_of(observation, scene, 4, 13);
  EXPECT_NEAR(second[place + 2], 6 / (3 * 5.25 * 3), 1e-14);
  EXPECT_NEAR(second[place], 6 / (4 * 3 * 3.0), 1e-14);  // across z it does not change
}

TEST(RodsBetweenPistons, ArePackedByThePresentVolume) {
  Scene scene = between_pistons("pressure_tensor", 3);
  scene.needles.diameter = 0.5;
  Observation observation(scene);
  const double packed = 3 * scene.composition()[0].volume();
  const std::size_t packing = place_of(observation, "rods", "packing_fraction");
  const std::size_t pressure = place_of(observation, "rods", "pressure");
  const std::size_t tensor = place_of(observation, "pressure_tensor", "kinetic_xx");
  EXPECT_NEAR(row_of(observation, scene, 0, 0)[packing], packed / 96, 1e-15);
  const auto row = row_of(observation, scene, 4, 13);
  EXPECT_NEAR(row[packing], packed / 60, 1e-15);
  EXPECT_NEAR(row[pressure], 26 / (24 * 4.0), 1e-14);  // both walls, across z
  EXPECT_NEAR(row[tensor], 13 / ((4 * 3 * (6.5 * 2 + 5 * 2) / 4) * 4), 1e-14);
}

TEST(PressureBetweenPistons, IsOnTheMeanAreaOfAllWalls) {
  Scene scene = between_pistons("fields", 3);
  scene.walls.push_back({.axis = "x", .side = "both"});
  PressureSums from, to;
  from.time = 1, from.normal_impulse = 2;
  to.time = 4, to.normal_impulse = 12;
  EXPECT_NEAR(Pressure(scene).between(from, to), 10 / ((24 + 6 * 5.25) * 3), 1e-14);
}

}  // namespace
}  // namespace needlework::observe
