// Walls, gravity and their hard cases in the event loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "src/engine/run.h"
#include "tests/engine/effect_scenes.h"
#include "tests/support/message_of.h"
#include "tests/support/one_body.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

using test::state_of;
using test::until_time;

struct Hit {
  double time;
  std::uint32_t needle, wall;
  double arm, velocity;
};

// A pair that slides makes a thousand bounces within a mean free time. In a small gas they are most
// of the collisions, and must not count for the mean free time: t_c would shrink with them until no
// bounce is resolved.
TEST(WallsAndGravity, LetPairsSlideInASmallGas) {
  Scene scene = test::inelastic(test::scene_of(30, 3, 2), 0.8);
  scene.needles.box[2] = 2;
  scene.needles.k = 2;
  scene.walls = {{.axis = "z", .side = "both"}};
  needlework::Run run(scene, make_gas(scene, draw_initial_state(scene)));
  const auto loop = make_loop(run, {.search = "linked-cells", .calendar = "tournament"});
  ASSERT_EQ(loop->advance(StopConditions(run, until_time(20))), Stop::time);
  EXPECT_GT(run.tally.tc_collisions, 100u);
  EXPECT_GT(run.windows.mean_free_time(), 0.5);
  EXPECT_LT(run.windows.mean_free_time(), 5);
}

TEST(GravityAlongPeriodicAxes, HasNoEndByEnergy) {
  Simulation run(test::effect_scene("chute"));
  Scene::Until until;
  until.energy_ratio = 0.5;
  EXPECT_THROW(run.advance(until), InputError);
}

// One needle in free space between walls on all axes, of the least edges that there may be.
Scene one_needle(double edge) {
  Scene scene = test::scene_of(1, edge);
  scene.walls = {
      {.axis = "x", .side = "both"}, {.axis = "y", .side = "both"}, {.axis = "z", .side = "both"}};
  return scene;
}

std::vector<Hit> hits_of(Simulation& run, double time) {
  std::vector<Hit> out;
  run.on_happening([&](const Happening& h) {
    out.push_back(
        {h.event.time, h.event.first, h.event.second, h.event.arm_first, h.event.normal_velocity});
  });
  run.advance(until_time(time));
  return out;
}

TEST(OneNeedle, StaysBetweenWallsOnAllAxes) {
  for (const double edge : {1.0, 1.5}) {
    const Scene scene = one_needle(edge);
    Simulation run(scene, state_of(scene, {0.5 * edge, 0.5 * edge, 0.5 * edge}, {0.36, 0.48, 0.8},
                                   {0.3, -0.5, 0.7}, {0.8, -0.6, 0.0}));
    const double energy = run.totals().energy;
    const std::vector<Hit> hits = hits_of(run, 200);
    EXPECT_GT(hits.size(), 300u);
    for (const Hit& hit : hits) {
      EXPECT_LE(hit.velocity, 0);
      EXPECT_EQ(std::abs(hit.arm), 0.5);
    }
    EXPECT_NEAR(run.totals().energy, energy, 1e-10);
    const State end = run.copy();
    for (int axis = 0; axis < 3; ++axis) {
      const double tip = 0.5 * std::abs(end.orientation[0][axis]);
      EXPECT_GE(end.position[0][axis], tip - 1e-12);
      EXPECT_LE(end.position[0][axis], edge - tip + 1e-12);
      EXPECT_EQ(end.image[0][axis], 0);
    }
  }
}

// A needle that comes down lying: of a uniform rod (k = 6) three hits turn it back as it came; for
// k = 3.1 two do, and it leaves turning.
TEST(OneNeedle, ThatComesDownLyingHitsWithBothTips) {
  Scene scene = one_needle(3);
  const auto run_of = [&](double k, std::vector<Hit>& hits) {
    scene.needles.k = k;
    Simulation run(scene, state_of(scene, {1.5, 1.5, 1}, {1, 0, 0}, {0, 0, -1}, {0, 0, 0}));
    hits = hits_of(run, 1.25);
    return run.copy();
  };
  std::vector<Hit> hits;
  State end = run_of(6, hits);
  ASSERT_EQ(hits.size(), 3u);
  EXPECT_EQ(hits[0].arm, 0.5);
  EXPECT_EQ(hits[1].arm, -0.5);
  EXPECT_EQ(hits[2].arm, 0.5);
  for (const Hit& hit : hits) EXPECT_NEAR(hit.time, 1, 1e-14);
  EXPECT_NEAR(end.velocity[0][2], 1, 1e-14);
  EXPECT_NEAR(end.angular_velocity[0][1], 0, 1e-13);
  end = run_of(3.1, hits);
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_GT(std::abs(end.angular_velocity[0][1]), 0.1);
  EXPECT_GT(end.velocity[0][2], 0);
}

// It falls upright from height h: the times of its bounces are known.
TEST(OneNeedle, BouncesUprightAsABallDoes) {
  Scene scene = test::scene_of(1, 4);
  scene.walls = {{.axis = "z", .side = "low", .epsilon = 0.5}};
  scene.forces.gravity = {0, 0, -2};
  Simulation run(scene, state_of(scene, {2, 2, 1.5}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}));
  const std::vector<Hit> hits = hits_of(run, 2.9);
  ASSERT_GE(hits.size(), 4u);
  double time = 1, speed = 2;
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_NEAR(hits[n].time, time, 1e-13);
    EXPECT_NEAR(hits[n].velocity, -speed, 1e-12);
    speed *= 0.5;
    time += speed;
  }
}

// It flies as high as it gets, far above the box.
TEST(OneNeedle, FliesHighAboveAnOpenBox) {
  Scene scene = test::scene_of(1, 4);
  scene.walls = {{.axis = "z", .side = "low"}};
  scene.forces.gravity = {0, 0, -1};
  Simulation run(scene, state_of(scene, {2, 2, 0.5}, {0, 0, 1}, {0.1, 0, 30}, {0, 0, 0}));
  run.advance(until_time(30));
  EXPECT_NEAR(run.copy().position[0][2], 450.5, 1e-9);
  EXPECT_NEAR(run.totals().energy, 0.5 * (900 + 0.01) + 0.5, 1e-9);
  run.advance(until_time(61));
  EXPECT_NEAR(run.copy().velocity[0][2], 29, 1e-9);
}

// Inelastic bounces grow ever shorter, and end in a clear error; the t_c rule keeps them finite.
TEST(OneNeedle, ThatClattersEndsInAnErrorOrByTheContactTime) {
  Scene scene = test::scene_of(1, 4);
  scene.walls = {{.axis = "z", .side = "low", .epsilon = 0.7}};
  scene.forces.gravity = {0, 0, -1};
  const State start = state_of(scene, {2, 2, 1.2}, {0.6, 0, 0.8}, {0.3, 0, 0}, {0, 0.1, 0});
  Simulation falls(scene, start);
  const std::string why =
      test::message_of<InvalidStateError>([&] { falls.advance(until_time(50)); });
  EXPECT_NE(why.find("wall of axis z"), std::string::npos) << why;
  scene.collisions.tc = 1e-3;
  scene.collisions.epsilon = 0.9;
  Simulation clatters(scene, start);
  clatters.advance(until_time(50));
  EXPECT_GT(clatters.events_by_source().at(0), 20u);
  EXPECT_LT(clatters.totals().energy, clatters.initial_energy());
}

// It lies on the floor, exactly along it, and no tip moves. Without gravity it stays there; with
// it, no bounce is ever long enough to be resolved, which is an error that says so, not a run
// without end.
TEST(OneNeedle, ThatLiesOnTheFloorAtRest) {
  Scene scene = one_needle(4);
  const auto lying = [&](double height) {
    return state_of(scene, {2, 2, height}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0});
  };
  for (const double height : {0.0, 0x1p-60, -0x1p-60}) {
    Simulation rests(scene, lying(height));
    EXPECT_EQ(hits_of(rests, 100).size(), 0u) << height;
    EXPECT_EQ(rests.copy().position[0][2], height);
  }
  scene.forces.gravity = {0, 0, -1};
  for (const double epsilon : {1.0, 0.5}) {
    scene.walls[2].epsilon = epsilon;
    for (const double height : {0.0, 0x1p-60, -0x1p-60}) {
      if (epsilon == 1 && height > 0) continue;  // it bounces on, 1e9 times in unit time
      Simulation falls(scene, lying(height));
      const std::string why =
          test::message_of<InvalidStateError>([&] { falls.advance(until_time(1)); });
      EXPECT_NE(why.find("collapse"), std::string::npos) << why << height << ", " << epsilon;
    }
  }
}

// Without gravity it may also move along the wall, for ever; and where it turns over a tip that
// lies there, the impulse on this one may leave the other without speed.
TEST(OneNeedle, ThatLiesOnTheFloorAndMoves) {
  for (const double k : {2.0, 3.1, 6.0, 10.0}) {
    Scene scene = one_needle(4);
    scene.needles.k = k;
    for (const double height : {0.0, 4.0}) {
      const auto hits = [&](const std::array<double, 3>& v, const std::array<double, 3>& w) {
        Simulation run(scene, state_of(scene, {2, 2, height}, {1, 0, 0}, v, w));
        const std::size_t out = hits_of(run, 5).size();
        EXPECT_NEAR(run.totals().energy, run.initial_energy(), 1e-15);
        return out;
      };
      EXPECT_EQ(hits({0.1, 0, 0}, {0, 0, 0}), 0u);
      EXPECT_EQ(hits({0, 0, 0}, {0, 0, 1}), 0u);
      EXPECT_EQ(hits({-0.3, 0.2, 0}, {0, 0, 2}), 0u);
      const std::size_t turned_over = hits({0, 0, 0}, {0, 1, 0});
      EXPECT_GE(turned_over, 1u);
      EXPECT_LE(turned_over, 20u);
    }
  }
}

// A tip that turns past the wall: a little above it there is no hit, a little into it there is one.
TEST(OneNeedle, ThatGrazesAWall) {
  const Scene scene = one_needle(4);
  for (const double depth : {1e-3, 1e-9, 1e-14}) {
    for (const double side : {1.0, -1.0}) {
      Simulation run(scene,
                     state_of(scene, {2, 2, 0.5 + side * depth}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}));
      const std::vector<Hit> hits = hits_of(run, std::numbers::pi - 0.01);
      EXPECT_EQ(hits.size(), side < 0 ? 1u : 0u) << depth;
      if (hits.empty()) continue;
      EXPECT_NEAR(hits[0].time, std::numbers::pi / 2, 2.1 * std::sqrt(depth));
    }
  }
}

// The wall comes from behind, faster than the needle leaves.
TEST(OneNeedle, IsCaughtByAWallFromBehind) {
  Scene scene = one_needle(4);
  // The surface is at its lowest, -1, at first, and rises at up to 6.
  scene.walls[2] = {
      .axis = "z",
      .side = "low",
      .motion = Scene::WallMotion{
          .amplitude = 1, .frequency = 3 / std::numbers::pi, .phase = 1.5 * std::numbers::pi}};
  scene.walls.push_back({.axis = "z", .side = "high"});
  Simulation run(scene, state_of(scene, {2, 2, 0.1}, {1, 0, 0}, {0, 0, 1}, {0, 0, 0}));
  const std::vector<Hit> hits = hits_of(run, 0.6);
  ASSERT_FALSE(hits.empty());
  const double t = hits[0].time;
  EXPECT_NEAR(0.1 + t, -std::cos(6 * t), 1e-12);
  EXPECT_LT(hits[0].velocity, 0);
  EXPECT_GT(run.copy().velocity[0][2], 1);
}

// The tip begins at the surface, as fast as it, and the surface leaves it ever faster, until it
// comes back: then the needle is hit, and not at the first touch.
TEST(OneNeedle, IsLeftByAWallThatMovesAwayAsFast) {
  Scene scene = one_needle(4);
  constexpr double frequency = 0.25, amplitude = 0.5, turn = 2 * std::numbers::pi * frequency;
  for (const double phase : {0.55, 0.75, 0.95}) {
    const double begin = phase * std::numbers::pi;
    scene.walls[2] = {.axis = "z",
                      .side = "low",
                      .motion = Scene::WallMotion{
                          .amplitude = amplitude, .frequency = frequency, .phase = begin}};
    scene.walls.push_back({.axis = "z", .side = "high"});
    const double low = amplitude * std::sin(begin), speed = amplitude * turn * std::cos(begin);
    Simulation run(scene, state_of(scene, {2, 2, low + 0.5}, {0, 0, 1}, {0, 0, speed}, {0, 0, 0}));
    scene.walls.pop_back();
    std::vector<Hit> hits = hits_of(run, 3.9);
    // What rounding leaves of the touch is no hit that could be noticed.
    std::erase_if(hits, [](const Hit& hit) { return hit.time < 1e-6 && hit.velocity > -1e-12; });
    ASSERT_FALSE(hits.empty()) << phase;
    const double t = hits[0].time;
    EXPECT_GT(t, 0.2) << phase;
    EXPECT_NEAR(low + speed * t, amplitude * std::sin(begin + turn * t), 1e-12) << phase;
    // There has been no other contact before.
    for (double s = 0.05; s < t - 1e-3; s += 1e-3)
      ASSERT_GT(low + speed * s, amplitude * std::sin(begin + turn * s)) << phase << ", " << s;
  }
}

// A wall that first moves away slower than the tip is met by it.
TEST(OneNeedle, FollowsAWallThatMovesAway) {
  Scene scene = one_needle(4);
  constexpr double frequency = 0.25, amplitude = 0.5;
  scene.walls[2] = {
      .axis = "z",
      .side = "low",
      .motion = Scene::WallMotion{
          .amplitude = amplitude, .frequency = frequency, .phase = std::numbers::pi / 2}};
  scene.walls.push_back({.axis = "z", .side = "high"});
  // The tip is at 1, the surface at A cos(2 pi f t): it begins to fall from 0.5 on.
  Simulation run(scene, state_of(scene, {2, 2, 1.5}, {0, 0, 1}, {0, 0, -0.5}, {0, 0, 0}));
  const std::vector<Hit> hits = hits_of(run, 4);
  ASSERT_FALSE(hits.empty());
  const double t = hits[0].time;
  EXPECT_NEAR(1 - 0.5 * t, amplitude * std::cos(2 * std::numbers::pi * frequency * t), 1e-12);
}

// Of inelastic needles on a vibrated floor: energy at the start, and all that hits and collisions
// have given and taken, against the energy at the end.
class EnergyOnAVibratedFloor {
 public:
  explicit EnergyOnAVibratedFloor(std::uint64_t hits) {
    Scene scene = test::scene_of(20, 3);
    scene.walls = {{.axis = "z",
                    .side = "low",
                    .epsilon = 0.9,
                    .motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 2, .phase = 0.3}}};
    scene.forces.gravity = {0, 0, -1};
    scene.collisions.epsilon = 0.95;
    scene.collisions.tc = 1e-6;
    Simulation run(scene);
    long double energy = 20.0L * run.totals().energy;
    double most = run.totals().energy;
    std::uint64_t found = 0;
    run.on_happening([&](const Happening& h) {
      energy += h.event.energy_change;
      found += !h.is_collision();
    });
    while (found < hits) {
      run.advance(until_time(run.time() + 100));
      most = std::max(most, run.totals().energy);
    }
    by_events = static_cast<double>(energy / 20) - run.totals().energy;
    by_events /= most;
    drift = run.energy_drift();
  }

  double by_events, drift;  ///< relative differences
};

TEST(Walls, KeepAnAccountOfTheEnergyThatCloses) {
  const EnergyOnAVibratedFloor account(20000);
  EXPECT_LT(std::abs(account.by_events), 1e-11);
  EXPECT_LT(std::abs(account.drift), 1e-11);
}

TEST(Walls, KeepAnAccountThatClosesOverAMillionHits_long) {
  const EnergyOnAVibratedFloor account(1000000);
  EXPECT_LT(std::abs(account.by_events), 1e-10);
  EXPECT_LT(std::abs(account.drift), 1e-10);
}

// A floor that goes down takes needles below the edge from which heights count.
TEST(Walls, DoNotEndARunThatNoEnergyEnds) {
  Scene scene = test::scene_of(0, 5);
  scene.needles = {.count = 40, .box = {5, 5, 3}, .seed = 2};
  scene.initial.t_tr = scene.initial.t_rot = 0.01;
  scene.walls = {{.axis = "z",
                  .side = "low",
                  .epsilon = 0.5,
                  .motion = Scene::WallMotion{.amplitude = 0.5, .frequency = 0.05, .phase = 0}}};
  scene.forces.gravity = {0, 0, -1};
  scene.collisions.epsilon = 0.5;
  scene.collisions.tc = 1e-2;
  Simulation run(scene);
  EXPECT_EQ(run.advance(until_time(14)), Stop::time);
  EXPECT_LT(40 * run.totals().energy, -1);
}

TEST(Walls, WorkUntilTheirMotionIsOld) {
  // Late in the run the phase has the digits that it had at first.
  Scene scene = test::scene_of(1, 4);
  scene.walls = {{.axis = "z",
                  .side = "low",
                  .motion = Scene::WallMotion{.amplitude = 0.25, .frequency = 1, .phase = 0}}};
  scene.forces.gravity = {0, 0, -1};
  Simulation run(scene, state_of(scene, {2, 2, 1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}));
  Hit last{};
  State after;
  run.on_happening([&](const Happening& h) {
    last = {h.event.time, 0, 0, 0, h.event.normal_velocity};
    after.resize(1);
    after.position[0] = h.event.after[0].position;
  });
  run.advance(until_time(3000));
  ASSERT_GT(last.time, 2900);
  EXPECT_NEAR(after.position[0][2] - 0.5, 0.25 * std::sin(2 * std::numbers::pi * last.time), 1e-11);
}

}  // namespace
}  // namespace needlework
