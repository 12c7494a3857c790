// Bodies that grow, in the event loop: laws that hold to rounding.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "tests/support/message_of.h"
#include "tests/support/rods.h"
#include "tests/support/scenes.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

using Vector = std::array<double, 3>;

Vector sum(const Vector& a, const Vector& b, double factor) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
double product(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Scene growing(Scene scene, double rate, double until_packing) {
  scene.driving.growth = Scene::Growth{};
  Scene::Growth& growth = *scene.driving.growth;
  growth.rate = rate;
  growth.until_packing = until_packing;
  growth.cool_every = 0;
  return scene;
}

Scene between_walls(Scene scene) {
  scene.walls = {wall("x", "both", 0.9), wall("z", "both")};
  return scene;
}

// d scale / dt.
double growth_of_scale(const Scene& scene, const State& state) {
  double squares = 0, mass = 0, diameters = 0;
  const Composition composition = scene.composition();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Species& its = composition[state.species.empty() ? 0 : state.species[i]];
    squares += its.mass * product(state.velocity[i], state.velocity[i]);
    mass += its.mass;
    diameters += its.diameter;
  }
  const double mean_diameter = diameters / static_cast<double>(state.size());
  return scene.driving.growth->rate * std::sqrt(squares / (3 * mass)) / mean_diameter;
}

Scene three_kinds() {
  Scene scene = rods_and_spheres(30, 8, 5);
  scene.collisions.tc.reset();
  return scene;
}

// By its diameter alone, a growing sphere is at D(t) from another when both meet.
TEST(GrowingSpheres, MeetWhereTheirDistanceIsTheirDiameter) {
  struct Case {
    double rate, velocity;  // of the second, away from the first
  };
  for (const Case& c : {Case{0.3, -1}, {0.3, 0.1}, {1, 0.4}, {1e-6, -1e-3}}) {
    SCOPED_TRACE(c.velocity);
    Scene scene = scene_of(0, 40);
    scene.species = {{.name = "spheres", .count = 2, .length = 0, .diameter = 1}};
    State state = draw_initial_state(scene);
    state.position = {Vector{20, 20, 20}, {23, 20, 20}};
    state.velocity = {Vector{}, {c.velocity, 0, 0}};
    // sqrt(T / m) of both is |v| / sqrt(6).
    const double speed = std::abs(c.velocity) / std::sqrt(6.0);
    scene = growing(scene, c.rate / speed, 0.02);
    Simulation run(scene, state);
    Collision last{};
    run.on_collision([&](const Collision& collision) { last = collision; });
    run.advance(until_collisions(1));
    const double expected = 2 / (c.rate - c.velocity);
    EXPECT_NEAR(last.time, expected, 1e-13 * expected);
    // They part at 2 G - V_n.
    EXPECT_NEAR(last.after[1].velocity[0] - last.after[0].velocity[0], 2 * c.rate - c.velocity,
                1e-13 * (c.rate + std::abs(c.velocity)));
  }
}

TEST(GrowingSpheres, AreNoLargerThanTheyAreTold) {
  Scene scene = scene_of(0, 40);
  scene.species = {{.name = "spheres", .count = 2, .length = 0, .diameter = 1}};
  State state = draw_initial_state(scene);
  state.position = {Vector{20, 20, 20}, {23, 20, 20}};
  state.velocity = {Vector{}, {1, 0, 0}};
  scene = growing(scene, 5, 1e-4);
  Simulation run(scene, state);
  EXPECT_EQ(run.advance({}), Stop::grown);
  EXPECT_NEAR(run.growth()->packing_fraction, 1e-4, 1e-15);
  const double scale = run.growth()->scale;
  EXPECT_NEAR(run.copy().own_bodies.diameter[1], scale, 1e-15 * scale);
  EXPECT_EQ(run.composition()[0].diameter, 1);
  EXPECT_EQ(run.collisions(), 0u);
}

// The work of growth is that of pressure: the relative rate times the virial of the centres.
struct GrowthCase {
  const char* name;
  Scene scene;
};
class GrowingGas : public testing::TestWithParam<GrowthCase> {};

TEST_P(GrowingGas, GainsTheVirialTimesTheRate) {
  const Scene& scene = GetParam().scene;
  const State start = draw_initial_state(scene);
  const double rate = growth_of_scale(scene, start);
  Simulation run(scene, start);
  double work = 0, change = 0, virial = 0;
  const double height = scene.needles.box[2], width = scene.needles.box[0];
  run.on_happening([&](const Happening& h) {
    const Collision& e = h.event;
    const double relative = rate / (1 + rate * e.time);
    if (h.kind == Happening::wall) {
      const auto [x, y, z] = e.after[0].position;
      const double apart[] = {x, width - x, z, height - z};
      work += relative * std::sqrt(product(e.impulse, e.impulse)) * apart[e.second];
      change += e.energy_change;
      return;
    }
    // The second needle's image, nearest to the first.
    Vector between = sum(e.after[0].position, e.after[1].position, -1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double edge = scene.needles.box[axis];
      between[axis] -= edge * std::round(between[axis] / edge);
    }
    work += relative * product(between, e.impulse);
    virial += product(between, e.impulse);
    change += e.energy_change;
  });
  run.advance(until_collisions(40));
  const double bodies = static_cast<double>(run.needles());
  const EnergyBudget budget = run.energy_budget();
  EXPECT_GT(work, 0);
  EXPECT_NEAR(*budget.growth * bodies, work, 1e-11 * work);
  EXPECT_NEAR(run.virial(), virial, 1e-11 * virial);
  double walls = 0;
  for (const double each : budget.walls) walls += each;
  EXPECT_NEAR((*budget.growth + budget.pairs + walls) * bodies, change, 1e-11 * work);
  EXPECT_EQ(*budget.cooling, 0);
  EXPECT_LT(std::abs(run.energy_drift()), 1e-11);
  for (std::size_t axis = 0; axis < 3 && scene.walls.empty(); ++axis) {
    EXPECT_NEAR(run.totals().momentum[axis], 0, 1e-11 * bodies);
  }
}

// Nobody is nearer than the present sizes let be.
TEST_P(GrowingGas, NeverOverlaps) {
  const Scene& scene = GetParam().scene;
  Simulation run(scene);
  for (int n = 1; n <= 10; ++n) {
    run.advance(until_collisions(5 * n));
    // A start of a gas that has these sizes and does not grow refuses bodies that overlap.
    Scene as_it_is = scene;
    as_it_is.driving.growth.reset();
    const State state = run.copy();
    EXPECT_NO_THROW(require_simulable(as_it_is, state));
  }
}

TEST_P(GrowingGas, IsCooledBackToItsTemperature) {
  Scene scene = GetParam().scene;
  scene.driving.growth->cool_every = 1;
  Simulation run(scene);
  const double at_start = run.totals().t_tr;
  int coolings = 0;
  double hottest = 0;
  std::uint64_t collisions = 0;
  for (int n = 1; n <= 400; ++n) {
    const double before = *run.energy_budget().cooling;
    const double collisions_per_needle = 2. * n / 20;
    run.advance(until_collisions(collisions_per_needle));
    hottest = std::max(hottest, run.totals().t_tr);
    if (*run.energy_budget().cooling == before) continue;
    ++coolings;
    collisions = run.collisions();
  }
  // 20 times as many collisions as bodies, and after a start in small steps, once for each.
  EXPECT_NEAR(coolings, 24, 8);
  EXPECT_GT(collisions, 0u);
  EXPECT_LT(hottest, 1.5 * at_start);
  const EnergyBudget budget = run.energy_budget();
  double walls = 0;
  for (const double each : budget.walls) walls += each;
  EXPECT_NEAR(run.totals().energy - run.initial_energy(),
              *budget.growth + *budget.cooling + budget.pairs + walls, 1e-11);
}

std::vector<GrowthCase> growth_cases() {
  Scene inelastic_spheres = rods_of(60, 0, 0.2, 3);
  inelastic_spheres.collisions.epsilon = 0.9;
  Scene sizes = rods_of(60, 0, 0.2, 4);
  sizes.species[0].drawn.diameter =
      Distribution{.shape = Distribution::Shape::lognormal, .mean = 1, .width = 0.2};
  Scene rough = inelastic_spheres;
  rough.collisions.beta = 0.5;
  return {{"spheres", growing(inelastic_spheres, 0.05, 0.7)},
          {"rough_spheres", growing(rough, 0.05, 0.7)},
          {"rods", growing(rods_of(60, 2, 0.15, 5), 0.05, 0.7)},
          {"kinds", growing(three_kinds(), 0.02, 0.7)},
          {"spheres_between_walls", growing(between_walls(rods_of(60, 0, 0.15, 6)), 0.05, 0.6)},
          {"rods_between_walls", growing(between_walls(rods_of(60, 2, 0.1, 7)), 0.1, 0.6)}};
}

INSTANTIATE_TEST_SUITE_P(Scenes, GrowingGas, testing::ValuesIn(growth_cases()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Growth, EndsWhereItIsToldOrHasNoRoom) {
  Scene scene = growing(rods_of(30, 0, 0.1), 0.1, 0.2);
  scene.driving.growth->cool_every.reset();
  {
    Simulation run(scene);
    EXPECT_EQ(run.advance(until_time(1e3)), Stop::grown);
    EXPECT_NEAR(run.growth()->packing_fraction, 0.2, 1e-13);
    const double time = run.time();
    EXPECT_EQ(run.advance(until_time(1e4)), Stop::grown);
    EXPECT_EQ(run.time(), time);
  }
  // Two diameters must fit in each edge.
  scene.driving.growth->until_packing = 0.9;
  scene.needles.box = {5, 5, 2.1};
  scene.species[0].count = 8;
  Simulation narrow(scene);
  EXPECT_EQ(narrow.advance(until_time(1e3)), Stop::no_room);
  EXPECT_NEAR(narrow.growth()->scale, 2.1 / 2.01, 1e-12);
  // What they have grown to fits.
  Scene still = scene;
  still.driving = {};
  still.species[0].diameter *= narrow.growth()->scale;
  EXPECT_NO_THROW(Simulation(still, narrow.copy()));
  // A pressure.
  scene = growing(rods_of(50, 0, 0.3), 0.1, 0.74);
  scene.driving.growth->cool_every.reset();
  scene.driving.growth->until_pressure = 30;
  Simulation pressed(scene);
  EXPECT_EQ(pressed.advance(until_time(1e3)), Stop::pressure);
  EXPECT_GE(pressed.growth()->pressure, 30);
  EXPECT_LT(pressed.growth()->pressure, 45);
  EXPECT_EQ(pressed.advance(until_time(1e3)), Stop::pressure);
}

// Searches know the largest sizes: what bodies would do beyond is not looked for, by which they
// would seem to have overlapped unseen.
TEST(Growth, IsSearchedToItsEndAndNotBeyond) {
  Scene scene = scene_of(0, 6.44, 224944);
  scene.needles.box = {6.44, 7.3425, 7.7218};
  scene.species = {{.name = "rods", .count = 40, .length = 1.5, .k = 6, .diameter = 0.5}};
  scene.species[0].drawn.length =
      Distribution{.shape = Distribution::Shape::uniform, .mean = 1.5, .width = 0.3};
  scene = growing(scene, 0.2, 0.6);
  std::string first;
  for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
    Simulation run(searched_by(scene, search));
    EXPECT_EQ(run.advance(until_time(1e3)), Stop::no_room) << search;
    if (first.empty()) first = run.trajectory_hash();
    EXPECT_EQ(run.trajectory_hash(), first) << search;
    EXPECT_GT(run.collisions(), 5u);
  }
}

TEST(Growth, EndsWhereBodiesJam) {
  Scene scene = growing(rods_of(40, 0, 0.3), 0.5, 0.74);
  scene.driving.growth->cool_every.reset();
  Simulation run(scene);
  EXPECT_EQ(run.advance(until_collisions(1e6)), Stop::jammed);
  EXPECT_GT(run.growth()->packing_fraction, 0.5);
  EXPECT_LT(run.growth()->packing_fraction, 0.7);
}

// The first collisions of a packing come far sooner than those of any gas that is no packing: they
// are cooled in time all the same.
TEST(Growth, GoesOnFromAPacking) {
  const auto packed = [](double pressure, double rate) {
    Scene scene = scene_of(0, 5);
    scene.species = {{.name = "spheres", .count = 100, .length = 0, .diameter = 0.8}};
    scene.driving.growth = Scene::Growth{};
    scene.driving.growth->rate = rate;
    scene.driving.growth->until_pressure = pressure;
    scene.until = until_collisions(5000);
    return scene;
  };
  Scene scene = packed(1e5, 0.03);
  Simulation first(scene);
  ASSERT_EQ(first.advance(scene.until), Stop::pressure);
  const State state = first.copy();
  scene = packed(1e7, 0.01);
  scene.species[0].diameter *= *state.scale;
  Simulation second(scene, state);
  ASSERT_EQ(second.advance(until_collisions(300)), Stop::collisions);
  EXPECT_LT(second.totals().t_tr, 1.1);
}

// What is drawn by growth.
TEST(Compress, FillsSpaceWhereNothingElseDoes) {
  Scene scene = rods_of(40, 0, 0.6, 3);
  scene.species.push_back({.name = "small", .count = 40, .length = 0, .diameter = 0.7});
  const double count_of_volumes = 40 * (1 + 0.343) * std::acos(-1.0) / 6;
  const double edge = std::cbrt(count_of_volumes / 0.6);
  scene.needles.box = {edge, edge, edge};
  scene.initial.packing = "compress";
  const State state = draw_initial_state(scene);
  EXPECT_NO_THROW(require_simulable(scene, state));
  EXPECT_TRUE(state.own_bodies.empty());
  Totals totals = Simulation(scene, state).totals();
  EXPECT_NEAR(totals.t_tr, 1, 1e-12);
  // The same on threads; "auto" comes to it, too.
  const State again = draw_initial_state(on_threads(scene, 2));
  EXPECT_EQ(again.position, state.position);
  scene.initial.packing = "auto";
  EXPECT_EQ(plan_placement(scene).way, PlannedPlacement::Way::grown);
  EXPECT_EQ(draw_initial_state(scene).position, state.position);
}

// Below an open side, too, where gravity holds them.
TEST(Compress, StaysInsideTheBox) {
  for (const char* side : {"low", "high"}) {
    Scene scene = rods_of(40, 0, 0.3);
    scene.forces.gravity = {0, 0, side[0] == 'l' ? -1.0 : 1.0};
    scene.walls = {wall("z", side)};
    scene.initial.packing = "compress";
    EXPECT_NO_THROW(require_simulable(scene, draw_initial_state(scene)));
  }
}

TEST(Compress, IsOfBodiesThatTakeUpRoomAndMove) {
  Scene scene = rods_of(60, 1, 0.2);
  scene.initial.packing = "compress";
  EXPECT_NO_THROW(draw_initial_state(scene));
  scene.species[0].diameter = 0;
  scene.species.push_back({.name = "thick", .count = 3, .diameter = 1});
  EXPECT_NE(message_of<InputError>([&] { draw_initial_state(scene); }).find("thin needles"),
            std::string::npos);
  scene.species[0].diameter = 1;
  scene.species[0].fixed = true;
  EXPECT_NE(message_of<InputError>([&] { draw_initial_state(scene); }).find("fixed"),
            std::string::npos);
  // What jams before is told.
  scene = rods_of(40, 0, 0.72);
  scene.initial.packing = "compress";
  EXPECT_NE(message_of<InputError>([&] { draw_initial_state(scene); }).find("jam at a packing"),
            std::string::npos);
}

}  // namespace
}  // namespace needlework::test
