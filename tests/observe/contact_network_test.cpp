// The contacts of bodies that grow, of states in which they are counted by hand.
#include <limits>

#include "tests/observe/observed.h"

namespace needlework::observe {
namespace {

Scene growing(std::size_t count, const Vector& box, double length = 0, double diameter = 1) {
  Scene scene = scene_with("contact_network", count, box);
  scene.species = {{.name = "a", .count = count, .length = length, .diameter = diameter}};
  scene.driving.growth = Scene::Growth{};
  return scene;
}

struct Network {
  double contacts, rattlers, gap;
};

Network network_of(const Scene& scene, const State& state, double pressure = 1e6) {
  Observation observation(scene);
  SpeciesSums sums = no_sums(scene);
  sums.growth.pressure = pressure;
  for (std::size_t n = 0; n < sums.walls.size(); ++n) {
    const Scene::WallSide side = scene.wall_sides()[n];
    sums.walls[n].axis = static_cast<int>(side.axis);
    sums.walls[n].high = side.is_high;
    sums.walls[n].place = side.is_high ? scene.needles.box[side.axis] : 0;
  }
  const auto values = observation.sample(state, totals_of(state, 1), sums);
  return {values[values.size() - 3], values[values.size() - 2], values[values.size() - 1]};
}

// As many along each axis, so far apart.
State lattice(std::size_t edge, double apart, const Vector& box) {
  State state = resting(edge * edge * edge, box);
  for (std::size_t i = 0; i < state.size(); ++i)
    state.position[i] = {apart * double(i % edge), apart * double(i / edge % edge),
                         apart * double(i / edge / edge)};
  return state;
}

TEST(ContactNetwork, CountsNeighboursInASimpleCubicLattice) {
  for (const double apart : {1.0 + 1e-12, 1.0005}) {
    const Vector box{4 * apart, 4 * apart, 4 * apart};
    const Network found = network_of(growing(64, box), lattice(4, apart, box));
    EXPECT_EQ(found.contacts, 6) << apart;
    EXPECT_EQ(found.rattlers, 0) << apart;
    EXPECT_DOUBLE_EQ(found.gap, 1e-3);
  }
  // Beyond the gap they are none.
  const Vector box{4.01, 4.01, 4.01};
  const Network apart = network_of(growing(64, box), lattice(4, 1.0025, box));
  EXPECT_TRUE(std::isnan(apart.contacts));
  EXPECT_EQ(apart.rattlers, 64);
}

TEST(ContactNetwork, HasAGapByThePressure) {
  const Vector box{4, 4, 4};
  const State state = lattice(2, 2, box);
  const auto gap = [&](double pressure) {
    return network_of(growing(8, box), state, pressure).gap;
  };
  EXPECT_DOUBLE_EQ(gap(1e9), 1e-6);
  EXPECT_DOUBLE_EQ(gap(1e6), 1e-3);
  EXPECT_DOUBLE_EQ(gap(10), 0.01);
  EXPECT_DOUBLE_EQ(gap(std::numeric_limits<double>::quiet_NaN()), 0.01);
}

// A sphere on top of a lattice between walls has one contact, those below it three and more.
TEST(ContactNetwork, TakesRattlersOffAgainAndAgain) {
  const Vector box{3, 3, 8};
  Scene scene = growing(29, box);
  scene.walls = {{.axis = "z", .side = "low"}, {.axis = "z", .side = "high"}};
  State state = lattice(3, 1, box);
  for (Vector& r : state.position) r[2] += 0.5;
  state.resize(29);
  state.position[27] = {0, 0, 3.5};
  state.position[28] = {0, 0, 4.5};
  state.orientation[27] = state.orientation[28] = {0, 0, 1};
  state.id[27] = 27;
  state.id[28] = 28;
  // Four neighbours beside each, those above and below, and the wall under the lowest layer; 27 has
  // two contacts, and without 28 one.
  const Network found = network_of(scene, state);
  EXPECT_EQ(found.rattlers, 2);
  EXPECT_DOUBLE_EQ(found.contacts, (9 * 6 + 9 * 6 + 9 * 5) / 27.0);
}

TEST(ContactNetwork, TakesPresentSizes) {
  const Vector box{6, 6, 6};
  State state = lattice(4, 1.5, box);
  state.own_bodies = {.length = std::vector<double>(64, 0.0),
                      .diameter = std::vector<double>(64, 1.5),
                      .mass = std::vector<double>(64, 1.0),
                      .inertia = std::vector<double>(64, 0.0)};
  EXPECT_EQ(network_of(growing(64, box), state).contacts, 6);
}

// Parallel rods in squares, end to end: each has four beside it, and two at its ends.
TEST(ContactNetwork, CountsContactsOfRods) {
  const Vector box{4, 4, 12};
  State state = resting(64, box);
  for (std::size_t i = 0; i < 64; ++i)
    state.position[i] = {double(i % 4), double(i / 4 % 4), 3 * double(i / 16)};
  const Network found = network_of(growing(64, box, 2, 1), state);
  EXPECT_EQ(found.contacts, 6);
  EXPECT_EQ(found.rattlers, 0);
  // A rod is held by six, a sphere by four.
  state.position[0][0] += 0.4;
  EXPECT_GT(network_of(growing(64, box, 2, 1), state).rattlers, 0);
}

}  // namespace
}  // namespace needlework::observe
