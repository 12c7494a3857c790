// Walls with a velocity, and walls that slide, in the event loop: laws that hold to rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "tests/support/message_of.h"
#include "tests/support/one_body.h"
#include "tests/support/rods.h"
#include "tests/support/scenes.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

// Walls along z of a box of this height.
Scene between(Scene scene, double height, const Scene::Wall& low, const Scene::Wall& high) {
  scene.needles.box[2] = height;
  scene.walls = {low, high};
  return scene;
}

Scene one_sphere(double height, const Scene::Wall& low, const Scene::Wall& high) {
  Scene scene = scene_of(0, 3);
  scene.species = {{.name = "sphere", .count = 1, .length = 0, .mass = 1.5, .diameter = 1}};
  return between(scene, height, low, high);
}

struct WallHit {
  double time;
  std::uint32_t wall;
  double normal_velocity;  // before
  std::array<double, 3> velocity;
  double place;  // of the centre along z
};

// All hits until then.
std::vector<WallHit> wall_hits(Simulation& run, double until) {
  std::vector<WallHit> out;
  run.on_happening([&](const Happening& h) {
    const auto& after = h.event.after[0];
    out.push_back(
        {h.event.time, h.event.second, h.event.normal_velocity, after.velocity, after.position[2]});
  });
  run.advance(until_time(until));
  run.on_happening({});
  return out;
}

// With a speed u just after a hit on the moving wall and a gap h left, h (u - V) is the same at
// every such hit: the body is back after 2 h / (u + V), with the speed u + 2 V.
TEST(Piston, LeavesItsInvariantAtEachHitOfOneBody) {
  struct Case {
    double velocity, speed, height;
    bool is_needle;
  };
  // Of the last, the wall is faster than the body.
  for (const Case& c : {Case{0.25, 1, 5, false},
                        {0.25, 1, 5, true},
                        {1e-2, 0.7, 2, false},
                        {3, 0.1, 4, true},
                        {3, 0.1, 4, false}}) {
    for (const bool is_high : {true, false}) {
      SCOPED_TRACE(c.velocity);
      const double sign = is_high ? -1 : 1;
      const Scene::Wall moving = piston("z", is_high ? "high" : "low", sign * c.velocity);
      const Scene::Wall resting = wall("z", is_high ? "low" : "high");
      Scene scene = one_sphere(c.height, is_high ? resting : moving, is_high ? moving : resting);
      if (c.is_needle) {
        scene.needles.count = 1;
        scene.species.clear();
      }
      // At first it flies towards the resting wall.
      const double start = 0.5 * c.height, gap = c.height - 1;
      Simulation run(
          scene, state_of(scene, {1, 1, start}, {0, 0, 1}, {0.3, 0, sign * c.speed}, {0, 0, 0}));
      const std::uint32_t index = is_high ? 1 : 0;
      double first = 0;
      int hits = 0;
      // Until the gap is some thousandth of its first.
      const double until = gap * (1 - 2e-3) / c.velocity;
      for (const WallHit& hit : wall_hits(run, until)) {
        if (hit.wall != index) continue;
        const double left = gap - c.velocity * hit.time;
        const double invariant = left * (sign * hit.velocity[2] - c.velocity);
        if (++hits == 1) first = invariant;
        if (hits > 150) break;  // rounding adds up
        EXPECT_NEAR(invariant, first, 1e-12 * first) << hits;
        EXPECT_EQ(hit.velocity[0], 0.3);
      }
      EXPECT_GT(hits, 100);
    }
  }
}

struct Seen {
  int kind;
  std::uint32_t first, second;
  double time, normal_velocity, impulse;
};

std::vector<Seen> first_events(const Scene& scene, const State& state, std::size_t count) {
  std::vector<Seen> out;
  Simulation run(scene, state);
  run.on_happening([&](const Happening& h) {
    const Collision& e = h.event;
    out.push_back({h.kind, e.first, e.second, e.time, e.normal_velocity, e.impulse[2]});
  });
  while (out.size() < count) run.advance(until_time(run.time() + 0.1));
  out.resize(count);
  return out;
}

// Two walls of one velocity are resting walls as one sees them who moves along.
TEST(Piston, IsARestingWallInAnotherFrame) {
  Scene needles = between(inelastic(scene_of(30, 3.2, 4), 0.9, 0), 2.5, wall("z", "low", 0.8),
                          wall("z", "high", 0.9));
  needles.collisions.tc = 1e-3;
  needles.forces.gravity = {0, 0, -0.5};
  const Scene spheres = between(rods_of(40, 0, 0.2), 5, wall("z", "low"), wall("z", "high"));
  const Scene rods = between(rods_of(20, 2, 0.1, 3), 5, wall("z", "low"), wall("z", "high", 0.7));
  for (const Scene& resting : {needles, spheres, rods}) {
    for (const double velocity : {0.3, -2.0}) {
      State state = draw_initial_state(resting);
      Scene moving = resting;
      for (Scene::Wall& each : moving.walls)
        each = piston("z", each.side.c_str(), velocity, {}, each.epsilon);
      constexpr std::size_t count = 250;
      const std::vector<Seen> moved = first_events(moving, state, count);
      for (auto& v : state.velocity) v[2] -= velocity;
      const std::vector<Seen> rested = first_events(resting, state, count);
      int hits = 0;
      for (std::size_t n = 0; n < count; ++n) {
        const Seen &a = moved[n], &b = rested[n];
        ASSERT_EQ(a.kind, b.kind) << n;
        ASSERT_EQ(a.first, b.first) << n;
        ASSERT_EQ(a.second, b.second) << n;
        // Rounding grows from collision to collision.
        const double near = 1e-13 * std::exp2(20.0 * static_cast<double>(n) / count);
        ASSERT_NEAR(a.time, b.time, near) << n;
        ASSERT_NEAR(a.normal_velocity, b.normal_velocity, 10 * near) << n;
        ASSERT_NEAR(a.impulse, b.impulse, 10 * near) << n;
        hits += a.kind == Happening::wall;
      }
      EXPECT_GT(hits, 30);
    }
  }
}

// Its velocity along z at this time, as the scene says it.
double velocity_of(const Scene& scene, const Scene::WallSide& side, double time) {
  const auto& motion = scene.walls[side.entry].motion;
  if (!motion || !motion->velocity) return 0;
  const double start = side.is_high ? scene.needles.box[side.axis] : 0;
  const bool rests = motion->stop_at && time >= (*motion->stop_at - start) / *motion->velocity;
  return rests ? 0 : *motion->velocity;
}

// What events say is what budgets say, at each of many moments: energy is the work of the walls and
// of gravity less what walls and pairs dissipate; momentum that of the start, of gravity and of all
// impulses.
void expect_closed_accounts(const Scene& scene, double end) {
  Simulation run(scene);
  const Composition composition = scene.composition();
  const std::vector<SpeciesIndex> species = composition.in_order_of_id();
  double mass = 0;
  for (const SpeciesIndex each : species) mass += composition[each].mass;
  const auto sides = scene.wall_sides();
  const auto all = static_cast<double>(species.size());
  std::vector<double> work(sides.size()), lost(sides.size()), given(sides.size());
  std::vector<std::array<double, 3>> impulse(sides.size());
  double of_pairs = 0, turnover = 0;
  run.on_happening([&](const Happening& h) {
    turnover += std::abs(h.event.energy_change);
    if (h.kind != Happening::wall) {
      of_pairs += h.event.energy_change;
      return;
    }
    const std::size_t n = h.event.second;
    const Scene::Wall& wall = scene.walls[sides[n].entry];
    const auto& j = h.event.impulse;
    for (std::size_t axis = 0; axis < 3; ++axis) impulse[n][axis] += j[axis];
    given[n] += h.event.energy_change;
    if (wall.temperature) {
      if (!wall.motion) return;
      ASSERT_EQ(sides[n].axis, 2u);
      work[n] += j[0] * (*wall.motion->tangential)[0] + j[1] * (*wall.motion->tangential)[1];
      return;
    }
    const double epsilon = h.event.contact_time_rule ? 1 : wall.epsilon;
    const double j_n = sides[n].is_high ? -j[sides[n].axis] : j[sides[n].axis];
    const double its_work = j[sides[n].axis] * velocity_of(scene, sides[n], h.event.time);
    // V_n^2 / K is -J V_n / (1 + epsilon).
    const double its_loss = -0.5 * (1 - epsilon) * j_n * h.event.normal_velocity;
    work[n] += its_work;
    lost[n] += its_loss;
    ASSERT_NEAR(h.event.energy_change, its_work - its_loss,
                1e-12 * (std::abs(its_work) + std::abs(its_loss) + std::abs(j_n)));
  });
  const double start = run.totals().energy * all;
  const auto momentum = run.totals().momentum;
  for (int n = 1; n <= 25; ++n) {
    run.advance(until_time(end * n / 25));
    const std::vector<WallTotals> walls = run.wall_totals();
    const EnergyBudget budget = run.energy_budget();
    const double near = 1e-12 * (turnover + std::abs(start));
    double energy = start + of_pairs + all * budget.gravity.value_or(0);
    std::array<double, 3> gained{};
    double pushed = 0;
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const bool draws = scene.walls[sides[w].entry].temperature.has_value();
      energy += draws ? given[w] : work[w] - lost[w];
      EXPECT_NEAR(walls[w].work * all, work[w], near) << n;
      EXPECT_NEAR(walls[w].energy * all, draws ? given[w] : work[w] - lost[w], near) << n;
      for (std::size_t axis = 0; axis < 3; ++axis) gained[axis] += impulse[w][axis];
      EXPECT_NEAR(walls[w].impulse_x, impulse[w][0], 1e-12 * walls[w].impulse);
      EXPECT_NEAR(walls[w].impulse_y, impulse[w][1], 1e-12 * walls[w].impulse);
      EXPECT_NEAR(walls[w].impulse_z, impulse[w][2], 1e-12 * walls[w].impulse);
      pushed += walls[w].impulse;
    }
    const Totals totals = run.totals();
    EXPECT_NEAR(totals.energy * all, energy, near) << n;
    EXPECT_LT(std::abs(run.energy_drift()), 1e-11) << n;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double falls = mass * scene.forces.gravity[axis] * run.time();
      EXPECT_NEAR(totals.momentum[axis], momentum[axis] + falls + gained[axis],
                  1e-12 * (pushed + std::abs(falls)) + 1e-13 * all)
          << axis;
    }
  }
  for (std::size_t w = 0; w < sides.size(); ++w) {
    if (!scene.walls[sides[w].entry].motion) continue;
    EXPECT_GT(std::abs(work[w]), 1e-3 * std::abs(start)) << w;
  }
}

TEST(Piston, KeepsAccountsOfEnergyAndMomentumThatClose) {
  // Both close in, one stops; they lose energy and the needles fall.
  Scene needles = between(inelastic(scene_of(60, 4, 2), 0.9, 0), 6,
                          piston("z", "low", 0.2, {}, 0.8), piston("z", "high", -0.5, 4.5, 0.9));
  needles.collisions.tc = 1e-3;
  needles.forces.gravity = {0, 0, -0.3};
  expect_closed_accounts(needles, 8);
  Scene mixture = rods_and_spheres(15, 6, 2);
  mixture = between(mixture, 8, piston("z", "low", -0.4), piston("z", "high", -0.8, 5.0));
  expect_closed_accounts(mixture, 6);
  mixture.forces.gravity = {0, 0, 1};
  expect_closed_accounts(mixture, 6);
}

TEST(Belt, KeepsAccountsOfEnergyAndMomentumThatClose) {
  Scene needles = between(scene_of(60, 4, 2), 3, belt("z", "low", 1, 0.7, -0.2),
                          belt("z", "high", 2, -0.7, 0.4));
  expect_closed_accounts(needles, 6);
  needles.forces.gravity = {0.4, -0.1, -0.5};
  expect_closed_accounts(needles, 6);
  Scene mixture = rods_and_spheres(15, 6, 2);
  mixture = between(mixture, 5, belt("z", "low", 1, 1), wall("z", "high", 0.9));
  mixture.forces.gravity = {0.2, 0.3, 0};
  expect_closed_accounts(mixture, 6);
}

// A body slower than the wall is left behind; where the wall stops, the body reaches it there.
TEST(Piston, ThatRecedesIsReachedWhereItStops) {
  for (const bool is_high : {true, false}) {
    const double sign = is_high ? 1 : -1;
    for (const bool stops : {false, true}) {
      const double start = is_high ? 3 : 0;
      const Scene::Wall moving = piston("z", is_high ? "high" : "low", sign * 0.5,
                                        stops ? std::optional(start + sign * 1.5) : std::nullopt);
      const Scene::Wall resting = wall("z", is_high ? "low" : "high");
      const Scene scene = one_sphere(3, is_high ? resting : moving, is_high ? moving : resting);
      Simulation run(scene,
                     state_of(scene, {1, 1, 1.5}, {0, 0, 1}, {0, 0, sign * 0.25}, {0, 0, 0}));
      const auto hits = wall_hits(run, 15);
      ASSERT_EQ(hits.size(), stops ? 1u : 0u);
      if (!stops) continue;
      EXPECT_NEAR(hits[0].time, 10, 1e-13);  // 2.5 from there to half a diameter before the stop
      EXPECT_EQ(hits[0].velocity[2], -sign * 0.25);
      EXPECT_EQ(run.copy().velocity[0][2], -sign * 0.25);
    }
  }
}

// A wall that advances meets what moves away slower than it does; at time 0 too, if it is there.
TEST(Piston, HitsWhatLeavesItTooSlowly) {
  for (const double speed : {0.4, -0.4}) {
    const Scene scene = one_sphere(6, piston("z", "low", 0.5), wall("z", "high"));
    for (const double away : {0.0, 0.2}) {
      Simulation run(scene,
                     state_of(scene, {1, 1, 0.5 + away}, {0, 0, 1}, {0, 0, speed}, {0, 0, 0}));
      const auto hits = wall_hits(run, 3);
      ASSERT_GE(hits.size(), 1u);
      EXPECT_NEAR(hits[0].time, away / (0.5 - speed), 1e-14);
      EXPECT_NEAR(hits[0].velocity[2], 1 - speed, 1e-15);
    }
  }
  const Scene scene = one_sphere(6, piston("z", "low", 0.5), wall("z", "high"));
  Simulation leaves(scene, state_of(scene, {1, 1, 0.5}, {0, 0, 1}, {0, 0, 0.6}, {0, 0, 0}));
  EXPECT_TRUE(wall_hits(leaves, 3).empty());
  // What lies across the wall as it is at time 0 is refused, whatever the wall does then.
  for (const double velocity : {0.5, -0.5}) {
    const Scene across = one_sphere(6, piston("z", "low", velocity), wall("z", "high"));
    EXPECT_THROW(Simulation(across, state_of(across, {1, 1, 0.4}, {0, 0, 1}, {0, 0, 9}, {0, 0, 0})),
                 InputError);
  }
}

// Without restitution a sphere goes on with the wall, and touches it for ever without any event;
// when the wall stops it takes off, and it stays on a wall that speeds away no more than it does.
TEST(Piston, CarriesWhatDoesNotReboundUntilItStops) {
  for (const double velocity : {0.3, -0.7}) {
    const double stop = 10 * velocity;
    const Scene scene = one_sphere(9, piston("z", "low", velocity, stop, 0), wall("z", "high"));
    Simulation run(scene, state_of(scene, {1, 1, 0.5}, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}));
    auto hits = wall_hits(run, 9.99);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_EQ(hits[0].velocity[2], velocity);
    EXPECT_NEAR(run.copy().position[0][2], 0.5 + velocity * run.time(), 1e-13);
    hits = wall_hits(run, 14);
    if (velocity > 0) {
      EXPECT_TRUE(hits.empty());
      EXPECT_NEAR(run.copy().position[0][2], 0.5 + 0.3 * 14, 1e-13);
    } else {
      // It comes to rest with the wall.
      ASSERT_EQ(hits.size(), 1u);
      EXPECT_NEAR(hits[0].time, 10, 1e-12);
      EXPECT_EQ(run.copy().velocity[0][2], 0);
      EXPECT_NEAR(run.copy().position[0][2], 0.5 + stop, 1e-13);
    }
  }
}

// A floor that falls freely away is left behind by none, and one that stops throws up what bounces
// on it under gravity: heights of bounces are those over a resting floor until then.
TEST(Piston, IsAFloorAsOneAtRestUntilItStops) {
  Scene scene = scene_of(1, 4);
  scene.forces.gravity = {0, 0, -2};
  scene.walls = {piston("z", "low", 0.5, 1.5)};  // until 3
  // It falls upright from 1 above the tip's place on the floor, which comes up with 1 / 2: seen
  // from there its speed is 1 / 2 less.
  Simulation run(scene, state_of(scene, {2, 2, 1.5}, {0, 0, 1}, {0, 0, 0.5}, {0, 0, 0}));
  const auto hits = wall_hits(run, 5.5);
  ASSERT_EQ(hits.size(), 3u);
  EXPECT_NEAR(hits[0].time, 1, 1e-13);
  EXPECT_NEAR(hits[0].velocity[2], 2.5, 1e-13);
  // It hits at 3 just as the floor stops, or is thrown up before: what is left of the flight is
  // known.
  EXPECT_NEAR(hits[1].time, 3, 1e-12);
}

TEST(Piston, TellsWhereItIsAndWhatItHasPressed) {
  Scene scene =
      between(scene_of(50, 4, 3), 6, piston("z", "low", 0.25, 1.0), piston("z", "high", -0.5));
  scene.walls.push_back(wall("x", "both"));
  Simulation run(scene);
  double time = 0;
  for (const double at : {1.0, 4.0, 6.0}) {
    run.advance(until_time(at));
    time = run.time();
    const auto walls = run.wall_totals();
    const double low = std::min(1.0, 0.25 * time), high = 6 - 0.5 * time;
    EXPECT_DOUBLE_EQ(walls[0].place, low);
    EXPECT_DOUBLE_EQ(walls[1].place, high);
    EXPECT_EQ(walls[0].area, 16);
    EXPECT_DOUBLE_EQ(walls[2].area, 4 * (high - low));
    EXPECT_DOUBLE_EQ(run.copy().box[2], high - low);
    EXPECT_DOUBLE_EQ(walls[1].pressure, walls[1].normal_impulse / (16 * time));
    // Means of 6 - 3 t / 4 up to 4, and of 5 - t / 2 from then on.
    const double mean =
        time <= 4 ? 6 - 0.375 * time : (4 * 4.5 + (time - 4) * (5 - 0.25 * (time + 4))) / time;
    EXPECT_NEAR(walls[3].pressure, walls[3].normal_impulse / (4 * mean * time),
                1e-14 * walls[3].pressure);
  }
}

// Thin needles never jam: walls that leave the longest no more room end the run at a known time.
TEST(Piston, EndsARunWhereWallsMeet) {
  Scene scene = between(scene_of(0, 5, 2), 6, piston("z", "low", 0.3), piston("z", "high", -0.2));
  scene.species = {{.name = "short", .count = 40, .length = 0.5}, {.name = "long", .count = 10}};
  Simulation run(scene);
  EXPECT_EQ(run.advance(until_collisions(1e9)), Stop::walls_meet);
  EXPECT_NEAR(run.time(), 10, 1e-12);
  const State end = run.copy();
  EXPECT_NEAR(end.box[2], 1, 1e-12);
  EXPECT_NEAR(end.low[2], 3, 1e-12);
  for (std::size_t i = 0; i < end.size(); ++i) {
    const double tip = 0.5 * (i < 40 ? 0.5 : 1) * std::abs(end.orientation[i][2]);
    EXPECT_GE(end.position[i][2] - tip, 3 - 1e-12);
    EXPECT_LE(end.position[i][2] + tip, 4 + 1e-12);
  }
  // A later time ends there too, and again.
  EXPECT_EQ(run.advance(until_time(20)), Stop::walls_meet);
  EXPECT_NEAR(run.time(), 10, 1e-12);
}

// The same bodies between walls that stay where they were.
Scene at_rest(Scene scene, const State& state) {
  for (Scene::Wall& each : scene.walls) each.motion.reset();
  scene.needles.box = state.box;
  return scene;
}

void expect_jam(const Scene& scene) {
  SCOPED_TRACE(name_of(scene));
  Simulation run(scene);
  EXPECT_EQ(run.advance(until_time(1e3)), Stop::jammed);
  const double time = run.time();
  State end = run.copy();
  const double extent = scene.species[0].length + scene.species[0].diameter;
  EXPECT_GT(end.box[2], extent);  // they have not met
  EXPECT_TRUE(std::isfinite(run.totals().energy));
  for (std::size_t i = 0; i < end.size(); ++i) end.position[i][2] -= end.low[2];
  end.low = {};
  // No two overlap and none is in a wall, which the engine would refuse, and they go on.
  Simulation rest(at_rest(scene, end), end);
  const double energy = rest.totals().energy;
  rest.advance(until_collisions(100));
  EXPECT_GE(rest.totals().collisions, 50 * rest.needles());
  if (scene.collisions.epsilon == 1) {
    EXPECT_NEAR(rest.totals().energy, energy, 1e-9 * energy);
  }
  // The run has ended at the same collision however it is searched, and resumed.
  for (const char* search : {"all-pairs", "capsules"}) {
    Simulation other(searched_by(scene, search));
    other.advance(until_time(0.7 * time));
    Simulation resumed(searched_by(scene, search), other.checkpoint());
    EXPECT_EQ(resumed.advance(until_time(1e3)), Stop::jammed);
    EXPECT_EQ(resumed.trajectory_hash(), run.trajectory_hash());
    EXPECT_EQ(resumed.time(), time);
  }
  // So does the run itself, which soon ends again.
  EXPECT_EQ(run.advance(until_time(1e3)), Stop::jammed);
  EXPECT_GE(run.time(), time);
  EXPECT_LT(run.time(), time * (1 + 1e-3));
}

TEST(Piston, EndsARunOfBodiesThatItJams) {
  for (const double length : {0.0, 0.7}) {
    Scene scene = length > 0 ? rods_of(14, length, 0.2, 5) : rods_of(5, length, 0.2, 5);
    const double side = length > 0 ? 3.5 : 2.2, height = length > 0 ? 6 : 4;
    const double velocity = length > 0 ? 10 : 0.5;
    scene.needles.box = {side, side, height};
    scene.walls = {piston("z", "low", velocity), piston("z", "high", -velocity)};
    expect_jam(scene);
    scene.collisions.epsilon = 0.8;
    scene.collisions.tc = 1e-3;
    for (Scene::Wall& each : scene.walls) each.epsilon = 0.9;
    expect_jam(scene);
  }
}

// Without t_c they jam cold: energies are those of the velocities of the walls.
TEST(Piston, EndsARunOfInelasticBodiesThatItJamsCold) {
  Scene scene = rods_of(5, 0, 0.2, 5);
  scene.needles.box = {2.2, 2.2, 4};
  scene.collisions.epsilon = 0.8;
  scene.walls = {piston("z", "low", 0.5, {}, 0.9), piston("z", "high", -0.5, {}, 0.9)};
  Simulation run(scene);
  EXPECT_EQ(run.advance(until_time(1e3)), Stop::jammed);
  EXPECT_LT(run.totals().energy, 5);
  EXPECT_GT(run.copy().box[2], 1);
}

// Dilute spheres fly far between collisions, so that times round much; that alone is no jam.
TEST(Piston, DoesNotCallADiluteGasJammed) {
  Scene scene = between(scene_of(0, 400), 400, wall("z", "low"), piston("z", "high", -0.01));
  scene.species = {{.name = "spheres", .count = 3, .length = 0, .diameter = 0.5}};
  Simulation run(scene);
  EXPECT_EQ(run.advance(until_time(2e4)), Stop::time);
  EXPECT_GT(run.wall_totals()[1].hits, 50u);
}

}  // namespace
}  // namespace needlework::test
