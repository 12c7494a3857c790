// Profiles along axes with walls, the centre of mass, pressure and phase of walls: states made by
// hand, whose values are known exactly.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "src/observe/registry.h"
#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

constexpr Vector walled_box{4, 5, 8};

Scene walled(const std::string& observable, std::size_t count) {
  Scene scene = scene_with(observable, count, walled_box, {1, 1, 4});
  scene.walls = {{.axis = "z", .side = "both"}};
  return scene;
}

TEST(WallProfiles, AreThoseOfTheNeedlesInEachSlab) {
  State state = resting(4, walled_box);
  // Two needles in the slab from 2 to 4, one in the last, one in the first.
  state.position = {{1, 1, 2.5}, {3, 4, 3.5}, {0, 0, 7.5}, {2, 2, 0.5}};
  state.velocity = {{1, 0, 2}, {0, 3, 4}, {0, 0, -1}, {0, 0, 0}};
  state.angular_velocity = {{2, 0, 0}, {0, 1, 1}, {3, 0, 0}, {0, 0, 0}};
  state.orientation = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0.6, 0.8}};
  Values values = Observed(walled("wall_profiles", 4)).sample(state);
  const double volume = 4 * 5 * 2, inertia = 1.0 / 12;
  EXPECT_EQ(values["density"], (std::vector<double>{1 / volume, 2 / volume, 0, 1 / volume}));
  EXPECT_EQ(values["position"], (std::vector<double>{1, 3, 5, 7}));
  EXPECT_EQ(values["thickness"], (std::vector<double>{2}));
  EXPECT_EQ(values["axis"], (std::vector<double>{2}));
  EXPECT_EQ(values["outside"], (std::vector<double>{0}));
  EXPECT_DOUBLE_EQ(values["flow"][1], 3);
  EXPECT_DOUBLE_EQ(values["t_tr"][1], (5 + 25) / 2.0 / 3);
  EXPECT_DOUBLE_EQ(values["t_normal"][1], (4 + 16) / 2.0);
  EXPECT_DOUBLE_EQ(values["t_rot"][1], inertia * (4 + 2) / 2.0 / 2);
  EXPECT_DOUBLE_EQ(values["p2"][1], (1 - 0.5) / 2);
  EXPECT_DOUBLE_EQ(values["p2"][0], 1.5 * 0.64 - 0.5);
  EXPECT_DOUBLE_EQ(values["p2"][3], -0.5);
  EXPECT_DOUBLE_EQ(values["cos2"][1], 0.5);
  EXPECT_DOUBLE_EQ(values["cos2"][0], 0.64);
  EXPECT_EQ(values["cos2"][3], 0);
  // Of u = (0, 0, 1) and (1, 0, 0), and of (0, 0.6, 0.8).
  const auto tensor = [&](std::size_t slab) {
    const auto begin = values["order_tensor"].begin() + static_cast<std::ptrdiff_t>(9 * slab);
    return std::vector<double>(begin, begin + 9);
  };
  ASSERT_EQ(values["order_tensor"].size(), 4u * 9);
  EXPECT_EQ(tensor(1), (std::vector<double>{0.25, 0, 0, 0, -0.5, 0, 0, 0, 0.25}));
  EXPECT_DOUBLE_EQ(tensor(0)[5], 1.5 * 0.6 * 0.8);
  EXPECT_DOUBLE_EQ(tensor(0)[7], 1.5 * 0.6 * 0.8);
  EXPECT_DOUBLE_EQ(tensor(0)[8], values["p2"][0]);
  for (const char* name : {"flow", "t_tr", "t_rot", "t_normal", "p2", "cos2", "order_tensor"}) {
    EXPECT_TRUE(std::isnan(values[name][values[name].size() / 2])) << name;
  }
}

// Of needles drawn between walls, at the distance d < 1/2 from one directors are uniform in
// |u_z| < x = 2 d: from x = a to b, weighted by the density, which is proportional to x,
// <u_z^2> = (a^2 + b^2) / 6 and <u_z^4> = (b^6 - a^6) / (15 (b^2 - a^2)). Tolerance: 4 standard
// errors.
TEST(WallProfiles, HaveTheAnglesOfAnIdealGasToTheWalls) {
  constexpr std::size_t slabs = 24;
  Scene scene = scene_with("wall_profiles", 20000, {9, 9, 3}, {1, 1, slabs});
  scene.walls = {{.axis = "z", .side = "both"}};
  Values values = Observed(scene).sample(draw_initial_state(scene));
  for (std::size_t n = 0; n < slabs; ++n) {
    const double a = 0.25 * static_cast<double>(std::min(n, slabs - 1 - n)), b = a + 0.25;
    const bool is_bulk = a >= 1;
    const double mean = is_bulk ? 1 / 3.0 : (a * a + b * b) / 6;
    const double fourth =
        is_bulk ? 1 / 5.0 : (std::pow(b, 6) - std::pow(a, 6)) / (15 * (b * b - a * a));
    const double needles = values["density"][n] * 9 * 9 / 8;
    EXPECT_GT(needles, 50);
    EXPECT_NEAR(values["cos2"][n], mean, 4 * std::sqrt((fourth - mean * mean) / needles)) << n;
  }
}

TEST(WallProfiles, LeaveSpheresOutOfTheAngles) {
  Scene scene = walled("wall_profiles", 3);
  scene.species = {{.name = "rod", .count = 2, .diameter = 0.1},
                   {.name = "ball", .count = 1, .length = 0, .diameter = 0.5}};
  State state = resting(3, walled_box);
  state.position = {{1, 1, 1}, {1, 1, 1}, {1, 1, 5}};
  state.orientation = {{0, 0, 1}, {0, 0, 1}, {0, 0.6, 0.8}};
  state.species = {0, 1, 0};
  Observation observation(scene);
  SpeciesSums sums = no_sums(scene);
  sums.totals = {{2, 0, 0}, {1, 0, 0}};
  sums.collisions = {0, 0, 0};
  const auto row = observation.sample(state, {}, sums);
  const auto cos2 = row.last((1 + 9) * 8 + 2).first(8);
  EXPECT_EQ(cos2[0], 1);
  EXPECT_DOUBLE_EQ(cos2[2], 0.64);
  for (std::size_t n = 4; n < 8; ++n) EXPECT_TRUE(std::isnan(cos2[n])) << n;
}

// Means over slabs are those of the gas.
TEST(WallProfiles, AddUpToTheTotals) {
  Scene scene = walled("wall_profiles", 300);
  scene.output.grid.reset();
  Simulation simulation(scene);
  const Totals totals = simulation.totals();
  Values values = Observed(scene).sample(simulation.copy(), totals);
  ASSERT_EQ(values["density"].size(), 64u);  // eighths of a needle
  double count = 0, t_tr = 0, t_rot = 0;
  for (std::size_t n = 0; n < 64; ++n) {
    if (values["density"][n] == 0) continue;
    const double needles = values["density"][n] * values["thickness"][0] * 4 * 5;
    count += needles;
    t_tr += needles * values["t_tr"][n];
    t_rot += needles * values["t_rot"][n];
  }
  EXPECT_NEAR(count, 300, 1e-11);
  EXPECT_NEAR(t_tr / 300, totals.t_tr, 1e-13);
  EXPECT_NEAR(t_rot / 300, totals.t_rot, 1e-13);
}

// They hold all needles where the surfaces may be, and tell how many are above an open side.
TEST(WallProfiles, CoverTheRoomOfTheirWalls) {
  Scene scene = walled("wall_profiles", 3);
  scene.walls[0].motion = {.amplitude = 0.5, .frequency = 1, .phase = 0};
  scene.walls.push_back({.axis = "x", .side = "low"});
  scene.walls.push_back({.axis = "y", .side = "high"});
  scene.forces.gravity = {-1, 2, 0};
  scene.output.grid = {{6, 2, 3}};
  const std::vector<Slabs> slabs = wall_slabs(scene);
  ASSERT_EQ(slabs.size(), 3u);
  const std::array begins{0.0, 5 - 15.0, -0.5}, ends{12.0, 5.0, 8.5};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(slabs[axis].axis, axis);
    EXPECT_EQ(slabs[axis].count, 6u);
    EXPECT_EQ(slabs[axis].begin, begins[axis]);
    EXPECT_DOUBLE_EQ(slabs[axis].begin + 6 * slabs[axis].thickness, ends[axis]);
  }
  State state = resting(3, walled_box);
  state.position = {{1, 1, -0.25}, {13, -11, 8.25}, {11.5, 4.5, 4}};
  Values values = Observed(scene).sample(state);
  EXPECT_EQ(values["outside"], (std::vector<double>{1, 1, 0}));
  EXPECT_EQ(values["axis"], (std::vector<double>{0, 1, 2}));
  // Without a grid they are an eighth of the longest needle thick, and 300 at most.
  scene.output.grid.reset();
  EXPECT_EQ(wall_slabs(scene).front().count, 120u);
  scene.needles.box[1] = 1000;
  EXPECT_EQ(wall_slabs(scene).front().count, 300u);
}

TEST(WallProfiles, AreOfEachSpecies) {
  Scene scene = walled("wall_profiles", 3);
  scene.species = {{.name = "light", .count = 2}, {.name = "heavy", .count = 1, .mass = 3}};
  State state = resting(3, walled_box);
  state.position = {{1, 1, 1}, {1, 1, 5}, {1, 1, 7}};
  state.velocity = {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
  state.species = {0, 1, 0};
  Observation observation(scene);
  SpeciesSums sums = no_sums(scene);
  sums.totals = {{2, 0, 0}, {1, 0, 0}};
  sums.collisions = {0, 0, 0};
  const auto row = observation.sample(state, {}, sums);
  const auto groups = observation.groups();
  const std::vector<SeriesField>& fields = groups.back().fields;
  EXPECT_EQ(fields.at(0).shape.front().name, "species");
  EXPECT_EQ(fields.at(0).width(), 8u);
  EXPECT_EQ(fields.at(12).name, "position");
  EXPECT_EQ(fields.at(12).values, (std::vector<double>{1, 3, 5, 7}));  // of both
  // Densities, flows and t_tr of both.
  const auto values = row.last(8 * 8 + 3 * 8 + 9 * 8 + 2);
  const double volume = 4 * 5 * 2;
  EXPECT_EQ(std::vector(values.begin(), values.begin() + 8),
            (std::vector<double>{1 / volume, 0, 0, 1 / volume, 0, 0, 1 / volume, 0}));
  EXPECT_EQ(values[8 + 3], 3);
  EXPECT_DOUBLE_EQ(values[16 + 6], 3 * 4.0 / 3);
}

TEST(CentreOfMass, IsAlongAxesWithWalls) {
  Scene scene = walled("centre_of_mass", 3);
  scene.walls.push_back({.axis = "x", .side = "low"});
  scene.forces.gravity = {-1, 0, 0};
  scene.species = {{.name = "light", .count = 2}, {.name = "heavy", .count = 1, .mass = 2}};
  State state = resting(3, walled_box);
  state.position = {{1, 2, 1}, {3, 2, 5}, {11, 2, 7}};
  state.velocity = {{1, 0, 3}, {-1, 0, 0}, {0, 0, 5}};
  state.species = {0, 1, 0};
  Observation observation(scene);
  SpeciesSums sums = no_sums(scene);
  sums.totals = {{2, 0, 0}, {1, 0, 0}};
  sums.collisions = {0, 0, 0};
  const auto row = observation.sample(state, {}, sums).last(12);
  EXPECT_EQ(std::vector(row.begin(), row.begin() + 4),
            (std::vector{(1 + 6 + 11) / 4.0, (1 + 10 + 7) / 4.0, -1 / 4.0, 8 / 4.0}));
  // Of the two light needles, and of the heavy one.
  EXPECT_EQ(std::vector(row.begin() + 4, row.end()),
            (std::vector<double>{6, 4, 3, 5, 0.5, 4, -1, 0}));
}

// Impulse along the normal over area and time since the sample before, also of a run that goes on.
TEST(WallSums, HaveThePressureBetweenSamples) {
  Scene scene = walled("alignment", 0);
  scene.output.observables.clear();
  scene.walls[0].side = "low";
  scene.walls[0].motion = {.amplitude = 0.5, .frequency = 1, .phase = 0};
  scene.forces.gravity[2] = -1;
  SpeciesSums sums = no_sums(scene);
  sums.walls[0].area = 20;
  Totals totals;
  const auto pressure_at = [&](Observation& observation, double time, double impulse) {
    totals.time = time;
    sums.walls[0].normal_impulse = impulse;
    sums.walls[0].phase = 1.5;
    const auto row = observation.sample({}, totals, sums);
    // Hits, impulse, phase, work, pressure; energies from pairs, from the wall and from callers.
    EXPECT_EQ(row.size(), 8u);
    EXPECT_EQ(row[2], 1.5);
    return row[4];
  };
  Observation observation(scene), other(scene);
  EXPECT_TRUE(std::isnan(pressure_at(observation, 0, 0)));
  EXPECT_EQ(pressure_at(observation, 2, 80), 2);
  EXPECT_TRUE(std::isnan(pressure_at(observation, 2, 80)));
  EXPECT_EQ(pressure_at(observation, 2.5, 70), -1);  // as a thermal wall may draw
  std::string bytes;
  Archive out = Archive::to(bytes);
  observation.transfer(out);
  Archive in = Archive::from(bytes);
  other.transfer(in);
  EXPECT_EQ(pressure_at(other, 3.5, 130), 3);
}

}  // namespace
}  // namespace needlework::observe
