// Rods of finite width in the event loop.
#include "tests/support/rods.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "src/engine/drawn_state.h"
#include "src/engine/initial_gas.h"
#include "src/machine/stop_request.h"
#include "src/scene/drawing.h"
#include "src/scene/rod_grid.h"
#include "src/search/ball_lists.h"
#include "src/search/bounding_volumes.h"
#include "tests/support/message_of.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

using test::rods_of;
using test::until_time;

// Rods of this state that overlap by more than `tolerance`.
int overlaps(const Scene& scene, const State& state, double tolerance) {
  const Composition composition = scene.composition();
  std::vector<RodShape> shapes;
  for (const SpeciesIndex its : composition.in_order_of_id(state.species))
    shapes.push_back({composition[its].length, composition[its].diameter, its});
  RodGrid grid(composition, shapes, box_of(state));
  int out = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    out += grid.overlap(state.position[i], state.orientation[i], shapes[i], tolerance).has_value();
    grid.enter(state.position[i], state.orientation[i], shapes[i]);
  }
  return out;
}

// Spheres that stay in balls through collisions keep lists of neighbours.
Scene in_search(Scene scene, const char* search, std::optional<double> radius = {}) {
  scene.engine.search = search;
  scene.engine.capsule_radius = radius;
  return scene;
}

std::vector<Scene> scenes_of_spheres() {
  const Scene dense = rods_of(300, 0, 0.49);
  // Several images of one sphere are near another one.
  const Scene tight = rods_of(7, 0, 0.4);
  Scene unequal = rods_of(100, 0, 0.2);
  unequal.species.push_back({.name = "small", .count = 200, .length = 0, .diameter = 0.6});
  unequal.collisions.epsilon = 0.9;
  unequal.collisions.tc = 1e-4;
  Scene between_walls = rods_of(150, 0, 0.2);
  between_walls.walls = {{.axis = "x", .side = "both"}};
  Scene slab = rods_of(40, 0, 0.3);
  slab.needles.box = {2.1, 2.5, 13};
  return {dense, tight, unequal, between_walls, slab};
}

void expect_one_trajectory_in_balls(double collisions, std::initializer_list<double> radii) {
  int n = 0;
  for (const Scene& scene : scenes_of_spheres()) {
    SCOPED_TRACE(n++);
    const auto course = [&](const Scene& of) {
      Simulation gas(of);
      gas.advance(test::until_collisions(collisions));
      // Records are replaced and balls left, all at once.
      const State state = gas.copy();
      std::vector<std::array<double, 3>> velocity = state.velocity;
      for (auto& v : velocity) v = {-v[1], v[0], 1.5 * v[2]};
      gas.set_velocities(velocity, state.angular_velocity);
      gas.advance(test::until_collisions(4 * collisions));
      return gas.trajectory_hash();
    };
    const std::string first = course(in_search(scene, "all-pairs"));
    for (const double radius : radii) {
      EXPECT_EQ(course(in_search(scene, "capsules", radius)), first) << radius;
    }
    EXPECT_EQ(course(in_search(scene, "auto")), first);
  }
}

TEST(Rods, SpheresInBallsHaveOneTrajectory) { expect_one_trajectory_in_balls(12, {0.02, 0.9}); }

TEST(Rods, SpheresInBallsHaveOneTrajectoryForLong_long) {
  expect_one_trajectory_in_balls(30, {0.02, 0.2, 0.9});
}

// Where spheres have balls, and where those would reach over more cells than lists can count.
TEST(Rods, SpheresHaveBallsWhereTheyAreCrowdedOnOneThread) {
  const auto gas_of = [](const Scene& scene) { return make_gas(scene, draw_initial_state(scene)); };
  const Gas dense = gas_of(rods_of(200, 0, 0.49)), dilute = gas_of(rods_of(200, 0, 0.1)),
            tight = gas_of(rods_of(7, 0, 0.4)), rods = gas_of(rods_of(200, 5, 0.3));
  const auto has_balls = [](const Gas& gas, const SearchSetup& setup) {
    return BallLists::suit(BoundingVolumes(gas, setup, BoundingVolume::capsule));
  };
  SearchSetup setup;
  EXPECT_FALSE(has_balls(dense, setup));
  setup.keep_lists = true;
  EXPECT_TRUE(has_balls(dense, setup));
  EXPECT_FALSE(has_balls(dilute, setup));
  EXPECT_FALSE(has_balls(rods, setup));
  setup.capsule_radius = 0.2;
  EXPECT_TRUE(has_balls(dilute, setup));
  setup.capsule_radius = 9;
  EXPECT_TRUE(has_balls(tight, setup));
  setup.cell_side = 0.13;
  EXPECT_FALSE(has_balls(tight, setup));
}

// They search less often than where they get another bounding volume at each collision, and look at
// fewer others.
TEST(Rods, SpheresInBallsLookAtTheirNeighboursOnly) {
  Simulation gas(in_search(rods_of(1000, 0, 0.49), "auto"));
  gas.advance(test::until_collisions(30));
  EXPECT_STREQ(gas.search().c_str(), "capsules");
  const Counters counters = gas.counters();
  EXPECT_LT(counters.searches, 1.3 * 2 * gas.collisions());
  EXPECT_LT(counters.candidates, 16 * counters.searches);
}

TEST(Rods, NeverOverlapAndKeepTheirEnergy) {
  for (const double length : {0.0, 1.0, 5.0}) {
    const Scene scene = rods_of(200, length, 0.25);
    Simulation gas(scene);
    const double energy = gas.totals().energy;
    for (int n = 1; n <= 5; ++n) {
      gas.advance(test::until_collisions(20 * n));
      EXPECT_EQ(overlaps(scene, gas.copy(), 1e-12), 0) << "length " << length;
    }
    EXPECT_NEAR(gas.totals().energy / energy, 1, 1e-12);
    EXPECT_LT(std::abs(gas.energy_drift()), 1e-12);
  }
}

TEST(Rods, SpheresDoNotTurn) {
  Simulation gas(rods_of(100, 0, 0.2));
  gas.advance(until_time(1));
  EXPECT_EQ(gas.totals().t_rot, 0);
  for (const auto& w : gas.copy().angular_velocity) {
    EXPECT_EQ(w, (std::array<double, 3>{}));
  }
}

TEST(Rods, ThatOverlapAtTheStartAreNamed) {
  const Scene scene = rods_of(2, 5, 0.001);
  State state = draw_initial_state(scene);
  state.position = {{3, 3, 3}, {3, 3, 3.9312}};
  state.orientation = {{1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(test::message_of<InputError>([&] { Simulation gas(scene, state); }),
            "state: rods 0 and 1 overlap: their axes are 0.9312 apart, less than 1");
}

TEST(Rods, BounceOffWallsByTheirCaps) {
  Scene scene = rods_of(60, 2, 0.05);
  scene.walls = {{.axis = "x", .side = "both"}, {.axis = "z", .side = "low", .epsilon = 0.9}};
  scene.forces.gravity = {0, 0, -1};
  scene.collisions.epsilon = 0.95;
  scene.collisions.tc = 1e-4;
  Simulation gas(scene);
  gas.advance(until_time(3));
  const State state = gas.copy();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double reach = std::abs(state.orientation[i][0]) + 0.5;
    EXPECT_GE(state.position[i][0] - reach, -1e-12);
    EXPECT_LE(state.position[i][0] + reach, scene.needles.box[0] + 1e-12);
  }
}

// A ball under gravity between a floor and a ceiling: between hits it flies as a point does whose
// box is lower by its diameter.
TEST(Rods, SpheresBounceAsPointsInALowerBox) {
  Scene scene;
  scene.needles.box = {4, 4, 3};
  scene.species = {{.name = "balls", .count = 1, .length = 0, .t_rot = 0, .diameter = 1}};
  scene.walls = {{.axis = "z", .side = "both"}};
  scene.forces.gravity = {0, 0, -0.5};
  State state = draw_initial_state(scene);
  state.position = {{1, 1, 1.5}};
  state.velocity = {{0.3, 0, 1.5}};
  Simulation gas(scene, state);
  // Up from z = 1 above the floor to the ceiling at 2, down to the floor, and up again.
  const double to_ceiling = (1.5 - std::sqrt(1.5 * 1.5 - 4 * 0.25)) / 0.5;
  const double at_ceiling = std::sqrt(1.5 * 1.5 - 1.0), at_floor = std::sqrt(1.5 * 1.5 + 1.0);
  const double across = (at_floor - at_ceiling) / 0.5;
  std::vector<double> times;
  gas.on_happening([&](const Happening& h) { times.push_back(h.event.time); });
  gas.advance(until_time(to_ceiling + 9.5 * across));
  ASSERT_EQ(times.size(), 10u);
  for (std::size_t n = 0; n < times.size(); ++n) {
    EXPECT_NEAR(times[n], to_ceiling + static_cast<double>(n) * across, 1e-11);
  }
}

// Rotation is none of theirs, whatever drives them.
TEST(Rods, SpheresDoNotTurnWhenDriven) {
  Scene scene;
  scene.species = {
      {.name = "balls", .count = 20, .length = 0, .mass = 2, .t_rot = 0, .diameter = 1.2},
      {.name = "rods", .count = 20, .length = 2, .diameter = 0.8}};
  scene.needles.box = {8, 8, 8};
  Scene::Wall floor, ceiling;
  floor.axis = ceiling.axis = "z";
  floor.side = "low";
  floor.motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 0.5};
  ceiling.side = "high";
  ceiling.temperature = 2;
  scene.walls = {floor, ceiling};
  scene.driving.andersen = {.rate = 0.5, .temperature = 1.5};
  scene.driving.kicks = {.every = 0.5, .translational = 0.1, .rotational = 0.2};
  Simulation gas(scene);
  gas.advance(until_time(3));
  const auto species = gas.species_totals();
  EXPECT_EQ(species[0].t_rot, 0);
  EXPECT_GT(species[1].t_rot, 0.1);
  EXPECT_TRUE(std::isfinite(gas.totals().energy));
}

TEST(RodPacking, FindsRoomUpToHighDensity) {
  for (const auto& [length, packing] :
       {std::pair(0.0, 0.49), std::pair(1.0, 0.45), std::pair(5.0, 0.55)}) {
    const Scene scene = rods_of(240, length, packing);
    const State state = draw_initial_state(scene);
    EXPECT_EQ(overlaps(scene, state, 1e-12), 0) << length;
    Simulation gas(scene, state);
    EXPECT_EQ(gas.advance(test::until_collisions(5)), Stop::collisions);
  }
}

// One big sphere among small ones, which would leave it no place.
Scene with_one_big(const std::vector<Species>& species, double edge) {
  Scene scene;
  scene.needles.box = {edge, edge, edge};
  scene.species = species;
  return scene;
}

TEST(RodPacking, PutsTheLargestFirst) {
  const Species small{.name = "small", .count = 2000, .length = 0, .diameter = 0.5};
  const Species big{.name = "big", .count = 1, .length = 0, .mass = 100, .diameter = 10};
  for (const auto& species : {std::vector{small, big}, std::vector{big, small}}) {
    const Scene scene = with_one_big(species, 21);
    const DrawnState drawn = draw_state(scene);
    EXPECT_EQ(overlaps(scene, drawn.state, 0), 0);
    EXPECT_TRUE(drawn.placement.starts_with("2001 rods inserted one by one, in 1.1"))
        << drawn.placement;
    // Ids are in the order of the scene.
    EXPECT_EQ(drawn.state.species.front(), 0);
    EXPECT_EQ(drawn.state.species.back(), 1);
    const PlannedPlacement plan = plan_placement(scene);
    EXPECT_EQ(plan.way, PlannedPlacement::Way::inserted);
    EXPECT_NEAR(plan.tries, 1.14, 0.02);
  }
}

// 864 spheres at 0.711: as many as 6 x 6 x 6 cells of fcc. With walls, hexagonal layers fit better.
TEST(RodPacking, PutsSpheresOnFcc) {
  Scene scene = rods_of(864, 0, 0.711);
  EXPECT_EQ(plan_placement(scene).way, PlannedPlacement::Way::on_lattice);
  const std::optional<State> lattice = place_rods_on_lattice(scene, RodOrder::parallel);
  ASSERT_TRUE(lattice);
  EXPECT_EQ(overlaps(scene, *lattice, 0), 0);
  // A box of three layers of 4 x 4 spheres, which square cells do not fit.
  scene = rods_of(48, 0, 0.7);
  const double stretch = 1 + 1e-3;
  scene.needles.box = {4 * stretch, 4 * std::sqrt(0.75) * stretch,
                       3 * std::sqrt(2.0 / 3) * stretch};
  const std::optional<State> layers = place_rods_on_lattice(scene, RodOrder::parallel);
  ASSERT_TRUE(layers);
  EXPECT_EQ(overlaps(scene, *layers, 0), 0);
}

// Tries by the estimate, which is that of a fluid, and those that insertion takes.
TEST(RodPacking, EstimatesTheTriesOfInsertion) {
  for (const auto& [length, packing] :
       {std::pair(0.0, 0.1), std::pair(0.0, 0.25), std::pair(5.0, 0.15)}) {
    const Scene scene = rods_of(500, length, packing);
    const Insertion done = insert_rods(scene, 1000000, 1000);
    ASSERT_EQ(done.placed, 500u);
    const double tries = static_cast<double>(done.tries) / 500;
    EXPECT_NEAR(std::log(plan_placement(scene).tries / tries), 0, 0.5) << length << " " << tries;
  }
}

// The largest eigenvalue of Q = <3 u u - 1> / 2, by powers of Q + 1, whose least one is 1/2.
double nematic_order(const State& state) {
  std::array<double, 3> axis = {0.5, 0.6, 0.7};
  double largest = 0;
  for (int n = 0; n < 200; ++n) {
    std::array<double, 3> next = {0, 0, 0};
    for (const std::array<double, 3>& u : state.orientation) {
      const double along = u[0] * axis[0] + u[1] * axis[1] + u[2] * axis[2];
      for (std::size_t k = 0; k < 3; ++k) next[k] += 1.5 * u[k] * along;
    }
    const auto count = static_cast<double>(state.size());
    for (std::size_t k = 0; k < 3; ++k) next[k] = next[k] / count + 0.5 * axis[k];
    const double size = std::hypot(next[0], next[1], next[2]);
    for (std::size_t k = 0; k < 3; ++k) axis[k] = next[k] / size;
    largest = size - 1;
  }
  return largest;
}

TEST(RodPacking, CrossedBlocksHaveNoOrder) {
  Scene scene = rods_of(250, 5, 0.44);
  scene.initial.packing = "crossed";
  const State state = draw_initial_state(scene);
  EXPECT_EQ(overlaps(scene, state, 1e-12), 0);
  EXPECT_LT(nematic_order(state), 0.3);
  scene.initial.packing = "lattice";
  EXPECT_GT(nematic_order(draw_initial_state(scene)), 0.7);
}

TEST(RodPacking, CrossedBlocksMayHaveAnyEdgesAndMixtures) {
  Scene scene = rods_of(200, 3, 0.3);
  scene.needles.box = {9, 13, 0};
  scene.needles.box[2] = 200 * scene.species[0].volume() / 0.3 / (9 * 13);
  Species& short_ones = scene.species.emplace_back(scene.species[0]);
  short_ones.name = "short";
  short_ones.length = 1;
  short_ones.k = homogeneous_k(1, 1);
  scene.species[0].count = short_ones.count = 100;
  scene.initial.packing = "crossed";
  EXPECT_EQ(overlaps(scene, draw_initial_state(scene), 1e-12), 0);
}

std::string refusal(const Scene& scene) {
  return test::message_of<InputError>([&] { draw_initial_state(scene); });
}

TEST(RodPacking, SaysWhatItCannotPlace) {
  // More than the densest packing of spheres, and than insertion reaches.
  Scene scene = rods_of(23, 0, 0.5);
  scene.needles.box = {2.5, 2.5, 2.5};
  EXPECT_EQ(refusal(scene),
            "the scene: needles.box = [2.5, 2.5, 2.5]: 23 spheres take up 0.7707 of it, and no "
            "packing more than 0.7405: expected a larger box");
  EXPECT_EQ(refusal(rods_of(13, 0, 0.73)),
            "initial.packing = \"auto\": no lattice of spheres has room for 13 spheres at a "
            "packing fraction of 0.73: expected a larger box, or edges that fit them better");
  scene = rods_of(11, 0, 0.7);
  scene.initial.packing = "insertion";
  EXPECT_EQ(refusal(scene),
            "initial.packing = \"insertion\": at a packing fraction of 0.7 a rod would find no "
            "place in 1000000 tries: expected \"lattice\", or a larger box");
  scene = rods_of(400, 5, 0.7);
  scene.initial.packing = "crossed";
  EXPECT_EQ(
      refusal(scene),
      "initial.packing = \"crossed\": no lattice of crossed blocks has room for 400 rods at a "
      "packing fraction of 0.7: expected a larger box, or edges that fit the rods better");
}

TEST(RodPacking, SaysHowRodsWerePlaced) {
  Scene scene = rods_of(64, 0, 0.1);
  EXPECT_TRUE(Simulation(scene).placement().starts_with("64 rods inserted one by one, in "));
  scene.initial.packing = "lattice";
  EXPECT_EQ(Simulation(scene).placement(),
            "64 rods placed on a lattice, then moved in 60 elastic collisions per rod");
  EXPECT_EQ(Simulation(scene, draw_initial_state(scene)).placement(), "");
  scene.initial.packing = "crossed";
  EXPECT_EQ(Simulation(scene).placement(),
            "64 rods placed in crossed blocks, then moved in 60 elastic collisions per rod");
  EXPECT_EQ(Simulation(test::scene_of(10, 5)).placement(), "");
}

// The elastic collisions end with one, whose rods may approach by the velocities that are drawn
// then.
TEST(RodPacking, LetsNoRodsTouchThatApproach) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Scene scene = rods_of(20, 0, 0.25);
    scene.initial.packing = "lattice";
    scene.needles.seed = seed;
    Simulation simulation(scene);
    double first = 0;
    simulation.on_collision([&](const Collision& collision) { first = collision.time; });
    simulation.advance(test::until_collisions(0.1));
    EXPECT_EQ(simulation.collisions(), 1u);
    EXPECT_GT(first, 1e-12) << seed;
  }
}

TEST(RodPacking, CanBeStopped) {
  Scene scene = rods_of(4000, 1, 0.45);
  scene.initial.packing = "lattice";
  int asked = 0;
  const StopRequest request([&] { return ++asked > 3 ? "enough" : ""; });
  EXPECT_THROW(draw_initial_state(scene), StoppedEarly);
}

}  // namespace
}  // namespace needlework
