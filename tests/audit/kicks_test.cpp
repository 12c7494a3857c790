// The audit finds nothing wrong with the kicks of the engine, and everything that is altered.
#include <gtest/gtest.h>

#include <cmath>

#include "needlework/error.h"
#include "tests/support/audited.h"
#include "tests/support/scenes.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

using audit::Findings;
using audit::Kind;

Scene kicked(double every = 0.1) {
  Scene scene = test::inelastic(scene_of(80, 4), 0.8);
  scene.driving.kicks = {.every = every, .translational = 1, .rotational = 2};
  return scene;
}

TEST(AuditOfKicks, FindsNothingWrongWithTheEngine_long) {
  Scene from_rest = kicked();
  from_rest.initial.t_tr = from_rest.initial.t_rot = 0;
  Scene mixture = kicked();
  mixture.needles.count = 0;
  mixture.species = {{.name = "short", .count = 60, .length = 0.6, .mass = 0.5, .k = 4},
                     {.name = "long", .count = 15, .length = 1.5, .mass = 7, .k = 6, .t_tr = 0.3}};
  Scene all = kicked();
  all.collisions.tc_relative.reset();
  all.collisions.tc = 1e-4;
  all.walls = {wall("z", "low", 0.9)};
  all.walls[0].motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 1.3, .phase = 0.7};
  all.forces.gravity = {0, 0, -1};
  Scene with_thermostat = kicked();
  with_thermostat.driving.andersen = {.rate = 0.5, .temperature = 2};
  for (const Scene& scene :
       {kicked(), kicked(0.013), kicked(2.5), from_rest, mixture, all, with_thermostat}) {
    const double every = scene.driving.kicks->every, time = 6.0 / audit_share;
    const Findings findings = audited(scene, time);
    expect_clean(findings, name_of(scene) + ", every " + std::to_string(every));
    EXPECT_EQ(findings.kicks, static_cast<std::uint64_t>(time / every));
    EXPECT_GT(findings.contacts, 50u / audit_share);
  }
}

TEST(AuditOfKicks, FindsNothingWrongWithRoughSpheres) {
  Scene scene = kicked(0.2);
  scene.needles.count = 0;
  scene.species = {{.name = "rough", .count = 40, .length = 0, .t_rot = 3, .diameter = 0.7},
                   {.name = "smooth", .count = 20, .length = 0, .diameter = 0.5},
                   {.name = "rods", .count = 20, .diameter = 0.2}};
  scene.pairs = {{.between = {"rough", "rough"}, .epsilon = {}, .beta = 0.4}};
  scene.driving.andersen = {.rate = 0.5, .temperature = 2};
  scene.walls = {wall("z", "low", 0.9), {.axis = "z", .side = "high", .temperature = 1.5}};
  const Findings findings = audited(scene, 2.0 / audit_share);
  expect_clean(findings, name_of(scene));
  EXPECT_EQ(findings.kicks, static_cast<std::uint64_t>(2.0 / audit_share / 0.2));
  EXPECT_GT(findings.contacts, 30u / audit_share);
}

// Which take up the momentum that kicks give.
TEST(AuditOfKicks, FindsNothingWrongBesideFixedBodies) {
  Scene scene = kicked(0.2);
  scene.needles.count = 0;
  scene.species = {{.name = "moving", .count = 40},
                   {.name = "still", .count = 10, .length = 0, .diameter = 0.4, .fixed = true}};
  const Findings findings = audited(scene, 2.0 / audit_share);
  expect_clean(findings, name_of(scene));
  EXPECT_EQ(findings.kicks, static_cast<std::uint64_t>(2.0 / audit_share / 0.2));
}

// Of points next to the circle, whose logarithm is that of a number which rounding has moved by
// more than its own digits: 4e-7 and 3e-9 inside it.
TEST(AuditOfKicks, KnowsHowFarRoundingMovesNumbersNextToTheCircle) {
  for (const std::uint64_t seed : {23136u, 437350u}) {
    Scene scene = kicked();
    scene.needles.seed = seed;
    scene.initial.t_tr = scene.initial.t_rot = 0;
    expect_clean(audited(scene, 0.1), std::to_string(seed));
  }
}

Scene sparse() {
  Scene scene = scene_of(30, 6);
  scene.driving.kicks = {.every = 0.5, .translational = 1, .rotational = 2};
  return scene;
}

// What it finds of three kicks, with another scene than that which ran.
std::uint64_t found(const std::function<void(Scene&)>& alter) {
  Scene other = sparse();
  alter(other);
  const double epoch = Simulation(sparse()).epoch_length();
  return audited(sparse(), 1.5, audit_setup(other, epoch)).count(Kind::wrong_rule);
}

TEST(AuditOfKicks, SeesOtherKicksThanThoseOfTheScene) {
  EXPECT_EQ(found([](Scene&) {}), 0u);
  EXPECT_EQ(found([](Scene& s) { s.needles.seed += 1; }), 90u);
  EXPECT_EQ(found([](Scene& s) { s.driving.kicks->translational *= 1 + 1e-11; }), 90u);
  EXPECT_EQ(found([](Scene& s) { s.driving.kicks->rotational *= 1 + 1e-11; }), 90u);
  // Needles that have collided after the time of a kick count as in wrong order.
  EXPECT_GE(found([](Scene& s) { s.driving.kicks->every = 0.25; }), 60u);
}

TEST(AuditOfKicks, SeesEachNumberThatIsWrong) {
  const Scene scene = sparse();
  const audit::Setup setup = audit_setup(scene, Simulation(scene).epoch_length());
  for (const auto member :
       {&State::position, &State::velocity, &State::orientation, &State::angular_velocity}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Findings findings =
          audited(scene, 0.5, setup, [&](State& after) { (after.*member)[7][axis] += 1e-12; });
      EXPECT_EQ(findings.count(Kind::wrong_rule), 1u) << axis;
      ASSERT_FALSE(findings.listed.empty());
      EXPECT_EQ(findings.listed[0].first, 7u);
      EXPECT_EQ(findings.listed[0].time, 0.5);
    }
  }
  // The momentum of the kick is not taken off.
  const Findings drifting = audited(scene, 0.5, setup, [](State& after) {
    for (auto& v : after.velocity) v[1] += 1e-12;
  });
  EXPECT_EQ(drifting.count(Kind::wrong_rule), 30u);
  EXPECT_THROW(audited(scene, 0.5, setup, [](State& after) { after.id[0] = 99; }), InputError);
}

// Needles that meet before the kick, and pass through each other.
TEST(AuditOfKicks, SeesWhatWasMissedBeforeIt) {
  Scene scene = scene_of(60, 4);
  scene.driving.kicks = {.every = 0.5, .translational = 1, .rotational = 1};
  Simulation simulation(scene);
  audit::Audit audit(simulation.copy(), audit_setup(scene, simulation.epoch_length()));
  simulation.advance(until_time(0.5));
  ASSERT_GT(simulation.collisions(), 10u);
  audit.add_kick(simulation.copy(), simulation.time());
  EXPECT_GE(audit.findings().count(Kind::missed), 5u);
  EXPECT_GE(audit.findings().count(Kind::wrong_rule), 10u);
}

}  // namespace
}  // namespace needlework::test
