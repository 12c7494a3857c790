// The audit of bodies that grow: it finds nothing wrong with the engine, and all that is planted.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "src/audit/audit.h"
#include "src/audit/rod_flight.h"
#include "tests/support/audited.h"
#include "tests/support/recorded_run.h"
#include "tests/support/rods.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

using audit::Findings;
using audit::Kind;

Scene growing(Scene scene, double rate, double until_packing = 0.3) {
  scene.driving.growth = Scene::Growth{.rate = rate, .until_packing = until_packing};
  return scene;
}

Scene between_walls() {
  Scene scene = growing(rods_of(20, 2, 0.05, 3), 0.03);
  scene.walls = {wall("z", "both"), wall("x", "both", 0.8)};
  scene.walls[1].motion = Scene::WallMotion{.amplitude = 0.2, .frequency = 0.3, .phase = 0.7};
  scene.collisions.tc = 1e-3;
  scene.forces.gravity = {0, 0, -0.1};
  return scene;
}

TEST(AuditOfGrowth, FindsNothingWrongWithTheEngine) {
  std::vector<Scene> scenes = {
      growing(rods_of(60, 0, 0.2), 0.1, 0.55),  growing(rods_of(60, 0, 0.4), 1e-3, 0.45),
      growing(rods_of(60, 3, 0.08), 0.05, 0.2), growing(rods_of(40, 1, 0.1), 0.02, 0.5),
      growing(rods_and_spheres(15, 9), 0.03),   between_walls()};
  scenes[0].driving.growth->cool_every = 0;
  scenes[2].collisions.epsilon = 0.9;
  scenes[2].collisions.tc = 1e-3;
  scenes[3].driving.growth->cool_every = 0.1;
  Scene& sizes = scenes.emplace_back(growing(rods_of(40, 1, 0.1), 0.05, 0.4));
  sizes.species[0].drawn.diameter = {
      .shape = Distribution::Shape::uniform, .mean = 1, .width = 0.3};
  for (const Scene& scene : scenes) {
    const RecordedRun run(scene, until_collisions(30.0 / audit_share));
    const Findings findings = run.audited();
    const std::string what = "scene " + std::to_string(&scene - scenes.data()) + ", ended as " +
                             name_of(run.stop) + " at " + std::to_string(run.end);
    expect_clean(findings, what);
    ASSERT_TRUE(findings.overlaps);
    EXPECT_LT(findings.overlaps->at_collisions, 1e-13) << what;
    EXPECT_EQ(findings.contacts, findings.collisions);
    EXPECT_GT(findings.contacts, 50u / audit_share) << what;
    EXPECT_EQ(findings.coolings > 0, scene.driving.growth->cool_every != 0.0) << what;
    EXPECT_EQ(findings.hits > 0, !scene.walls.empty());
  }
}

// What it finds where this is another scene than that which ran.
Findings found(const RecordedRun& run, const std::function<void(Scene::Growth&)>& alter) {
  RecordedRun other = run;
  alter(*other.setup.driving.growth);
  return other.audited();
}

TEST(AuditOfGrowth, SeesOtherGrowthThanThatOfTheScene) {
  const RecordedRun run(growing(rods_of(40, 2, 0.1), 0.02), until_collisions(8));
  EXPECT_TRUE(found(run, [](auto&) {}).clean());
  const Findings faster = found(run, [](auto& growth) { growth.rate *= 1 + 1e-8; });
  EXPECT_GT(faster.count(Kind::late), 20u);
  EXPECT_GT(faster.count(Kind::wrong_rule), 20u);
  const Findings slower = found(run, [](auto& growth) { growth.rate *= 1 - 1e-8; });
  EXPECT_GT(slower.count(Kind::early) + slower.count(Kind::spurious), 20u);
  // From the second instant on.
  EXPECT_GT(found(run, [](auto& growth) { growth.cool_every = 1.01; }).count(Kind::wrong_order),
            run.kicks.size() / 2);
  EXPECT_THROW(found(run, [](auto& growth) { growth.cool_every = 0; }), InputError);
}

class FalseReportOfCooling : public testing::Test {
 protected:
  std::uint64_t altered(Kind kind, const std::function<void(State&)>& alter) const {
    RecordedRun other = run;
    alter(other.kicks[other.kicks.size() / 2].after);
    return other.audited().count(kind);
  }
  const RecordedRun run{growing(rods_of(30, 2, 0.1), 0.05), until_collisions(10)};
};

TEST_F(FalseReportOfCooling, OfAnyNumberIsSeen) {
  ASSERT_GT(run.kicks.size(), 3u);
  for (const auto member :
       {&State::position, &State::velocity, &State::orientation, &State::angular_velocity}) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_GE(altered(Kind::wrong_rule, [&](State& s) { (s.*member)[7][axis] += 1e-11; }), 1u);
  }
}

TEST_F(FalseReportOfCooling, ByAnotherFactorOrOfSomeIsSeen) {
  const auto times = [](auto& rows, double factor) {
    for (auto& row : rows)
      for (double& each : row) each *= factor;
  };
  EXPECT_EQ(altered(Kind::wrong_rule, [](State&) {}), 0u);
  EXPECT_GE(altered(Kind::wrong_rule, [&](State& s) { times(s.velocity, 1 + 1e-12); }), 30u);
  EXPECT_GE(altered(Kind::wrong_rule, [&](State& s) { times(s.angular_velocity, 1 - 1e-12); }),
            30u);
}

TEST_F(FalseReportOfCooling, ThatIsLeftOutOrAtAnotherTimeIsSeen) {
  const std::size_t n = run.kicks.size() / 2;
  RecordedRun other = run;
  other.kicks[n].time += 1e-9;
  EXPECT_EQ(other.audited().count(Kind::wrong_order), 1u);
  other = run;
  other.kicks.erase(other.kicks.begin() + static_cast<std::ptrdiff_t>(n));
  EXPECT_GE(other.audited().count(Kind::wrong_order), 1u);
  // What happens before it is checked until it.
  other = run;
  other.leave_out(other.kicks[n].happenings - 1);
  EXPECT_GE(other.audited().count(Kind::missed), 1u);
}

class FalseReportOfGrowingHits : public testing::Test {
 protected:
  FalseReportOfGrowingHits() {
    while (run.happenings[n].kind != Happening::wall ||
           std::abs(run.happenings[n].event.impulse[2]) < 0.1)
      ++n;
  }
  std::uint64_t altered(Kind kind, const std::function<void(Collision&)>& alter) const {
    RecordedRun other = run;
    alter(other.happenings[n].event);
    return other.audited().count(kind);
  }
  const RecordedRun run{between_walls(), until_collisions(8)};
  std::size_t n = run.happenings.size() / 2;
};

TEST_F(FalseReportOfGrowingHits, IsSeen) {
  EXPECT_TRUE(run.audited().clean());
  EXPECT_EQ(altered(Kind::late, [](Collision& c) { c.offset += 1e-9; }), 1u);
  EXPECT_EQ(altered(Kind::early, [](Collision& c) { c.offset -= 1e-9; }), 1u);
  const auto wrong = [&](auto&& alter) { return altered(Kind::wrong_rule, alter); };
  EXPECT_EQ(wrong([](Collision& c) { c.arm_first *= 1 + 1e-12; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.normal_velocity += 1e-12; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.impulse[2] += 1e-12; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.energy_change += 1e-10; }), 1u);
  EXPECT_GE(wrong([](Collision& c) { c.after[0].velocity[2] += 1e-12; }), 1u);
  RecordedRun other = run;
  other.leave_out(n);
  EXPECT_GE(other.audited().count(Kind::missed), 1u);
}

// What it finds of the end of a run to a packing fraction of 0.12, given as another end.
std::uint64_t wrong_ends(const std::function<void(Scene::Growth&, Stop&, double&)>& alter) {
  Scene scene = growing(rods_of(20, 1, 0.1), 0.05, 0.12);
  Simulation simulation(scene);
  Stop stop = simulation.advance(scene.until);
  double end = simulation.time();
  EXPECT_EQ(stop, Stop::grown);
  alter(*scene.driving.growth, stop, end);
  audit::Audit audit(Simulation(scene).copy(), audit_setup(scene, simulation.epoch_length(), 0));
  audit.finish(end);
  audit.check_end(scene.until, stop, end);
  return audit.findings().count(Kind::wrong_end);
}

TEST(AuditOfGrowth, SeesOtherEnds) {
  EXPECT_EQ(wrong_ends([](auto&, auto&, auto&) {}), 0u);
  EXPECT_EQ(wrong_ends([](auto& growth, auto&, auto&) { growth.until_packing = 0.12 + 1e-9; }), 1u);
  EXPECT_EQ(wrong_ends([](auto& growth, auto&, auto&) { growth.until_packing = 0.12 - 1e-9; }), 1u);
  EXPECT_EQ(wrong_ends([](auto&, auto&, double& end) { end *= 1 + 1e-9; }), 1u);
  EXPECT_EQ(wrong_ends([](auto&, Stop& stop, auto&) { stop = Stop::pressure; }), 1u);
  EXPECT_EQ(wrong_ends([](auto&, Stop& stop, auto&) { stop = Stop::no_room; }), 1u);
  EXPECT_EQ(wrong_ends([](auto&, Stop& stop, auto&) { stop = Stop::nothing_can_happen; }), 1u);
}

TEST(AuditOfGrowth, SeesOtherPressuresAtTheEnd) {
  Scene scene = rods_of(50, 0, 0.3);
  scene.driving.growth = Scene::Growth{.rate = 0.05, .until_pressure = 12};
  const RecordedRun run(scene, scene.until);
  EXPECT_EQ(run.stop, Stop::pressure);
  const auto wrong = [&](double pressure) {
    RecordedRun other = run;
    other.setup.share = 0;  // no flights of pairs
    other.setup.driving.growth->until_pressure = pressure;
    return other
        .audited([&](audit::Audit& audit) { audit.check_end(scene.until, run.stop, run.end); })
        .count(Kind::wrong_end);
  };
  EXPECT_EQ(wrong(12), 0u);
  EXPECT_EQ(wrong(20), 1u);
  EXPECT_EQ(wrong(8), 1u);
}

// All at one velocity, so that nothing else brings them together.
TEST(AuditOfGrowth, FindsNothingWrongWithBodiesThatMoveAlike) {
  const Scene scene = growing(rods_of(20, 1, 0.1), 0.05, 0.3);
  State alike = Simulation(scene).copy();
  alike.velocity.assign(alike.size(), {1, 0.5, 0});
  alike.angular_velocity.assign(alike.size(), {});
  Simulation simulation(scene, alike);
  audit::Audit audit(simulation.copy(), audit_setup(scene, simulation.epoch_length()));
  simulation.on_happening([&](const Happening& happening) { audit.add(happening); });
  simulation.on_kick([&] { audit.add_kick(simulation.copy(), simulation.time()); });
  const Stop stop = simulation.advance(until_collisions(5));
  audit.finish(simulation.time());
  audit.check_end(until_collisions(5), stop, simulation.time());
  expect_clean(audit.findings(), name_of(stop));
  EXPECT_GT(simulation.collisions(), 20u);
}

TEST(AuditOfGrowth, RefusesARelativeContactTime) {
  Scene scene = growing(rods_of(20, 1, 0.1), 0.05);
  const Simulation simulation(scene);
  scene.collisions.tc_relative = 1e-3;
  EXPECT_THROW(audit::Audit(simulation.copy(), audit_setup(scene, simulation.epoch_length())),
               InputError);
}

// Bodies at rest that grow into each other, as a sphere and a rod that turns: the time follows from
// their sizes.
TEST(RodFlight, SeesWhenBodiesGrowIntoEachOther) {
  audit::Space space{.box = {40, 40, 40}, .longest = 20, .gravity = {}};
  space.growth.emplace(0.25, 2);
  const auto body = [](double x, double length, const std::array<double, 3>& u,
                       const std::array<double, 3>& w, const audit::Instant& record) {
    return audit::Needle({record, {{x, 0, 0}}, {}, {u}, {w}}, {.length = length, .diameter = 1});
  };
  const audit::Instant then{2, 0.5};  // when sizes are 1.625 times those at the start
  const auto time_of_scale = [](double scale) { return (scale - 1) / 0.25 - 2.5; };
  // Two spheres; ends on each other; an end on a side, and the side turns.
  struct Case {
    double length, turn;
    std::array<double, 3> director;
    double extent;
  };
  for (const Case& each :
       {Case{0, 0, {1, 0, 0}, 1}, Case{2, 0, {1, 0, 0}, 3}, Case{2, 3, {0, 0, 1}, 2}}) {
    const audit::Needle one = body(0, each.length, {1, 0, 0}, {0, 0, 0}, then);
    const audit::Needle other = body(6, each.length, each.director, {each.turn, 0, 0}, {1, 0});
    audit::RodFlight flight(one, other, {0, 0, 0}, space);
    const double touch = time_of_scale(6 / each.extent);
    for (const double off : {1e-3, 1e-9, 1e-12}) {
      EXPECT_FALSE(flight.overlap(0, touch * (1 - off))) << each.extent;
      const auto found = flight.overlap(0, touch * (1 + off) + 1e-9);
      ASSERT_TRUE(found) << each.extent;
      EXPECT_NEAR(*found, touch, 1e-11) << each.extent;
      EXPECT_FALSE(flight.gave_up());
      EXPECT_LT(flight.looked_at(), 3000) << each.extent;
    }
    EXPECT_NEAR(flight.contact(touch), 6 / each.extent, 1e-12);
    EXPECT_NEAR(flight.at(touch).rate, -0.25 * each.extent, 1e-12) << each.extent;
    EXPECT_LT(flight.overlap_at(touch), 1e-14);
    EXPECT_NEAR(flight.overlap_at(touch + 0.1), 0.025 * each.extent / (6 / each.extent + 0.025),
                1e-12);
  }
}

}  // namespace
}  // namespace needlework::test
