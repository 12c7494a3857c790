// The audit finds nothing wrong with the engine, and everything that is planted.
#include "src/audit/audit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "tests/support/audit_setup.h"
#include "tests/support/audited.h"
#include "tests/support/by_build.h"
#include "tests/support/reference_gas.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework::test {
namespace {

using audit::Findings;
using audit::Kind;

constexpr int thin = test::by_build(1, 10);

/// A run of the engine, recorded with all that the audit needs.
struct EngineRun {
  State initial;
  std::vector<Collision> collisions;
  audit::Setup setup;
  double end = 0;

  EngineRun(const Scene& scene, double per_needle) {
    Followed run(scene);
    initial = run->copy();
    setup = audit_setup(scene, run->epoch_length());
    run->advance(until_collisions(per_needle / thin));
    end = run->time();
    collisions = run.collisions;
  }

  Findings audited() const {
    audit::Audit audit(initial, setup);
    for (const Collision& collision : collisions) audit.add(collision);
    audit.finish(end);
    return audit.findings();
  }
};

Scene gas(std::uint64_t count, double density) {
  return scene_of(count, std::cbrt(static_cast<double>(count) / density));
}

void expect_clean_contacts(const Findings& findings, const std::string& what) {
  expect_clean(findings, what);
  EXPECT_GT(findings.contacts, 0u);
}

void expect_clean_runs(double collisions_per_needle) {
  std::vector<Scene> scenes;
  for (const double density : {0.05, 0.72, 11.6}) {
    scenes.push_back(gas(150, density));
    Scene& cooling = scenes.emplace_back(test::inelastic(gas(150, density), 0.8));
    cooling.initial.t_rot = 0;
    Scene& rough = scenes.emplace_back(gas(150, density));
    rough.collisions.epsilon = 0.9;
    rough.collisions.beta = 0.3;
    rough.collisions.tc = 1e-3;
    rough.needles.k = 2;
  }
  scenes.push_back(scene_of(60, 2.01));  // a pair can meet through two images
  scenes.push_back(scene_of(2, 2.01));
  Scene& slow = scenes.emplace_back(gas(100, 1));
  slow.initial.t_tr = slow.initial.t_rot = 0x1p-560;
  for (const Scene& scene : scenes) {
    const EngineRun run(scene, (scene.needles.count == 2 ? 10 : 1) * collisions_per_needle);
    expect_clean_contacts(run.audited(), name_of(scene));
  }
}

TEST(Audit, FindsNothingWrongWithTheEngine) { expect_clean_runs(10); }

TEST(Audit, FindsNothingWrongInLongerRuns_long) { expect_clean_runs(30); }

// --- Mixtures.

Scene mixture() {
  Scene scene = scene_of(0, 5);
  scene.species = three_species();
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc_relative = 1e-3;
  scene.pairs = {{.between = {"short", "long"}, .epsilon = 0.6, .beta = 0.2},
                 {.between = {"middle", "middle"}, .epsilon = 1, .beta = {}}};
  return scene;
}

TEST(Audit, FindsNothingWrongWithMixtures) {
  std::vector<Scene> scenes = {mixture()};
  // The same in other units of length, mass and energy.
  Scene& small = scenes.emplace_back(mixture());
  for (double& edge : small.needles.box) edge *= 3e-5;
  for (Species& each : small.species) {
    each.length *= 3e-5;
    each.mass *= 1e20;
    each.t_tr *= 1e-30;
    each.t_rot *= 1e-30;
  }
  // Lengths 1 to 20, masses 1 to 1e6, elastic.
  Scene& unequal = scenes.emplace_back(scene_of(0, 2.5));
  unequal.species = {{.name = "dust", .count = 120, .length = 0.05, .mass = 1e-6},
                     {.name = "rod", .count = 20, .length = 1, .mass = 1}};
  Scene& one = scenes.emplace_back(scene_of(0, 20));
  one.species = {{.name = "rod", .count = 60, .length = 6, .mass = 0.1, .k = 3}};
  one.collisions.epsilon = 0.8;
  one.collisions.tc_relative = 1e-3;
  for (const Scene& scene : scenes) {
    const EngineRun run(scene, 20);
    expect_clean_contacts(run.audited(), name_of(scene));
  }
}

// A run of other needles than those of the scene.
TEST(Audit, SeesOtherNeedlesThanThoseOfTheMixture) {
  const EngineRun run(mixture(), 8);
  const auto found = [&](Kind kind, auto&& alter) {
    std::vector<Species> species = run.setup.composition.species();
    alter(species);
    EngineRun other = run;
    other.setup.composition = Composition(species, {});
    for (std::size_t a = 0; a < species.size(); ++a) {
      for (std::size_t b = a; b < species.size(); ++b) {
        other.setup.composition.set_restitution(a, b, run.setup.composition.restitution(a, b));
      }
    }
    return other.audited().count(kind);
  };
  EXPECT_EQ(found(Kind::wrong_rule, [](auto&) {}), 0u);
  EXPECT_GT(found(Kind::wrong_rule, [](auto& all) { all[1].mass *= 1 + 1e-9; }), 0u);
  EXPECT_GT(found(Kind::wrong_rule, [](auto& all) { all[0].k *= 1 + 1e-9; }), 0u);
  EXPECT_GT(found(Kind::missed, [](auto& all) { all[0].length *= 1.05; }), 0u);
  EXPECT_GT(found(Kind::spurious, [](auto& all) { all[1].length *= 0.95; }), 0u);
  EngineRun other = run;
  other.setup.composition.set_restitution(1, 2, {0.9 + 1e-9, -1});
  EXPECT_GT(other.audited().count(Kind::wrong_rule), 0u);
}

TEST(Audit, FollowsBouncesDownToTheContactTime_long) {
  Scene scene = test::inelastic(gas(60, 2), 0.5, 1e-4);
  const EngineRun run(scene, 300);
  const auto by_rule = std::count_if(run.collisions.begin(), run.collisions.end(),
                                     [](const Collision& c) { return c.contact_time_rule; });
  EXPECT_GT(by_rule, 100 / thin);
  expect_clean_contacts(run.audited(), name_of(scene));
}

TEST(Audit, LooksAtEveryPairAndCollision) {
  const EngineRun run(gas(40, 1), 20);
  const Findings findings = run.audited();
  const std::size_t n = run.initial.size(), m = run.collisions.size();
  EXPECT_EQ(findings.collisions, m);
  EXPECT_EQ(findings.contacts, m);
  // Two flights to each of the others, one between the partners; all again at the end, but
  // perhaps those that begin there.
  const std::size_t at_collision = 2 * (n - 2) + 1, most = m * at_collision + n * (n - 1) / 2;
  EXPECT_LE(findings.checked, most);
  EXPECT_GE(findings.checked, most - at_collision);
}

TEST(Audit, ChecksAShareOfAllPairsByItsSeed) {
  const EngineRun run(gas(100, 1), 20);
  const auto share = [&](double share, std::uint64_t seed) {
    EngineRun part = run;
    part.setup.share = share;
    part.setup.seed = seed;
    return part.audited();
  };
  const Findings all = run.audited(), fifth = share(0.2, 1), other = share(0.2, 2);
  EXPECT_NEAR(static_cast<double>(fifth.checked), 0.2 * static_cast<double>(all.checked),
              0.02 * static_cast<double>(all.checked));
  EXPECT_EQ(fifth.checked, share(0.2, 1).checked);
  EXPECT_NE(fifth.contacts, other.contacts);
  EXPECT_TRUE(fifth.clean() && other.clean());
  EXPECT_EQ(share(0, 1).checked, 0u);
  EXPECT_TRUE(std::isnan(share(0, 1).bound95(Kind::missed)));
}

TEST(Audit, BoundsWhatItDidNotSee) {
  Findings findings;
  findings.contacts = findings.collisions = 1000;
  EXPECT_NEAR(findings.bound95(Kind::late), 2.9957e-3, 1e-6);  // -log(0.05) / n
  findings.differences[0] = 2;                                 // missed
  EXPECT_NEAR(findings.bound95(Kind::missed), 6.2958 / 1002, 1e-6);
}

// --- Faults planted in the engine: a history that is consistent but wrong.

constexpr int collisions = 500 / thin;

struct PlantedCase {
  const char* name;
  Fault fault;
  Kind kind;
};

static void PrintTo(const PlantedCase& planted, std::ostream* out) { *out << planted.name; }

class PlantedFault : public testing::TestWithParam<PlantedCase> {};

TEST_P(PlantedFault, IsReported) {
  const PlantedCase& planted = GetParam();
  Scene scene = gas(20, 1.5);
  const ReferenceRun run = run_reference(scene, collisions, planted.fault);
  ASSERT_GT(run.planted, 0);
  audit::Audit audit(run.initial, audit_setup(scene, reference_epoch));
  for (const Collision& collision : run.collisions) audit.add(collision);
  audit.finish(run.end);
  const Findings& findings = audit.findings();
  const auto expected = static_cast<std::uint64_t>(run.planted);
  EXPECT_GE(findings.count(planted.kind) + 1, expected)
      << listed(findings);  // one may lie at the end
  EXPECT_LE(findings.count(planted.kind), expected) << listed(findings);
  EXPECT_GT(findings.count(planted.kind), 0u) << listed(findings);
}

INSTANTIATE_TEST_SUITE_P(
    OfTheEngine, PlantedFault,
    testing::Values(PlantedCase{"Drop", {Fault::drop, 40 / thin}, Kind::missed},
                    PlantedCase{"Late", {Fault::delay, 40 / thin, 1e-9}, Kind::late},
                    PlantedCase{"Early", {Fault::delay, 40 / thin, -1e-9}, Kind::early},
                    PlantedCase{"Blind", {Fault::blind, 1}, Kind::missed},
                    PlantedCase{"Repeat", {Fault::repeat, 40 / thin}, Kind::spurious},
                    PlantedCase{
                        "Restitution", {Fault::restitution, 40 / thin, 1e-10}, Kind::wrong_rule}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(PlantedFault, NoneIsReportedWhereThereIsNone) {
  const Scene scene = gas(20, 1.5);
  const ReferenceRun run = run_reference(scene, collisions, {});
  audit::Audit audit(run.initial, audit_setup(scene, reference_epoch));
  for (const Collision& collision : run.collisions) audit.add(collision);
  audit.finish(run.end);
  expect_clean_contacts(audit.findings(), "reference");
}

// --- Faults in what is reported.

class FalseReport : public testing::Test {
 protected:
  FalseReport() : run(gas(60, 2), 40) {
    // In the middle, and of needles that have both collided before.
    n = run.collisions.size() / 2;
  }
  Collision& victim() { return run.collisions[n]; }
  std::uint64_t count(Kind kind) const { return run.audited().count(kind); }

  EngineRun run;
  std::size_t n;
};

TEST_F(FalseReport, OfACollisionLeftOutIsSeen) {
  run.collisions.erase(run.collisions.begin() + static_cast<std::ptrdiff_t>(n));
  EXPECT_GE(count(Kind::missed), 1u);
}

TEST_F(FalseReport, OfACollisionThatWasNotIsSeen_long) {
  Collision invented = victim();
  invented.offset -= 1e-4;
  invented.time -= 1e-4;
  while (n > 0 && invented.time < run.collisions[n - 1].time) --n;
  run.collisions.insert(run.collisions.begin() + static_cast<std::ptrdiff_t>(n), invented);
  EXPECT_GE(count(Kind::spurious) + count(Kind::late) + count(Kind::early), 1u);
  EXPECT_GE(count(Kind::wrong_rule), 1u);
}

TEST_F(FalseReport, OfTheTimeIsSeen) {
  victim().offset += 1e-9;
  EXPECT_GE(count(Kind::late), 1u);
}

TEST_F(FalseReport, OfTheOrderIsSeen) {
  std::swap(run.collisions[n], run.collisions[n + 1]);
  EXPECT_EQ(count(Kind::wrong_order), 1u);
}

// At one instant ids decide, but a collision may cause another one of its own needles.
TEST_F(FalseReport, OfTheOrderAtOneInstantIsSeen) {
  run.setup.share = 0;  // no flights: with such reports they would take long
  victim().first = 30;
  victim().second = 40;
  const std::uint64_t before = count(Kind::wrong_order);
  const auto wrong_with_next = [&](std::uint32_t first, std::uint32_t second) {
    const std::vector<Collision> kept = run.collisions;
    Collision next = victim();
    next.first = first;
    next.second = second;
    run.collisions.insert(run.collisions.begin() + static_cast<std::ptrdiff_t>(n) + 1, next);
    const std::uint64_t found = count(Kind::wrong_order);
    run.collisions = kept;
    return found - before;
  };
  EXPECT_EQ(wrong_with_next(31, 41), 0u);
  EXPECT_EQ(wrong_with_next(10, 20), 1u);
  EXPECT_EQ(wrong_with_next(10, 30), 0u);
  EXPECT_EQ(wrong_with_next(10, 40), 0u);
}

TEST_F(FalseReport, OfTheOrderWithinAPairIsSeen) {
  std::swap(victim().first, victim().second);
  std::swap(victim().after[0], victim().after[1]);
  EXPECT_GE(count(Kind::wrong_order), 1u);
}

TEST_F(FalseReport, OfAnyNumberIsSeen_long) {
  const auto altered = [&](auto&& alter) {
    const Collision kept = victim();
    alter(victim());
    const std::uint64_t found = count(Kind::wrong_rule);
    victim() = kept;
    return found;
  };
  EXPECT_EQ(count(Kind::wrong_rule), 0u);
  EXPECT_EQ(altered([](Collision& c) { c.arm_first += 1e-10; }), 1u);
  EXPECT_EQ(altered([](Collision& c) { c.arm_second += 1e-10; }), 1u);
  EXPECT_EQ(altered([](Collision& c) { c.sin_angle += 1e-10; }), 1u);
  EXPECT_EQ(altered([](Collision& c) { c.shift[0] += 1; }), 1u);
  EXPECT_EQ(altered([](Collision& c) { c.normal_velocity *= 1 + 1e-10; }), 1u);
  EXPECT_EQ(altered([](Collision& c) { c.impulse[1] += 1e-10; }), 1u);
  EXPECT_EQ(altered([](Collision& c) { c.energy_change += 1e-10; }), 1u);
  EXPECT_EQ(altered([](Collision& c) { c.contact_time_rule = true; }), 1u);
  EXPECT_EQ(altered([](Collision& c) { c.time *= 1 + 1e-12; }), 1u);
  EXPECT_GE(altered([](Collision& c) { c.after[0].position[2] += 1e-10; }), 1u);
  EXPECT_GE(altered([](Collision& c) { c.after[1].velocity[0] += 1e-10; }), 1u);
  EXPECT_GE(altered([](Collision& c) { c.after[0].angular_velocity[1] += 1e-10; }), 1u);
  EXPECT_GE(altered([](Collision& c) { c.after[1].orientation[0] += 1e-10; }), 1u);
  EXPECT_GE(altered([](Collision& c) { c.after[1].orientation[0] = NAN; }), 1u);
}

TEST(ContactTime, OfAnAbsoluteKindIsChecked) {
  Scene scene = gas(60, 5);
  scene.collisions.epsilon = 0.5;
  scene.collisions.tc = 0.01;
  EngineRun run(scene, 40);
  EXPECT_TRUE(run.audited().clean());
  *run.setup.tc *= 1.5;
  EXPECT_GT(run.audited().count(Kind::wrong_rule), 0u);
}

// One needle spins above another, so fast that the contact finder gives up: the rest of the flight
// is undecided, also if the flight ends there.
TEST(Audit, ReportsThatItGaveUp) {
  State state;
  state.box = {8, 8, 8};
  state.id = {0, 1};
  state.position = {{4, 4, 4}, {4, 4, 4.4}};
  state.orientation = {{0.8, 0, 0.6}, {0, 1, 0}};
  state.velocity = {{0, 0, 0}, {0, 0, 0}};
  state.angular_velocity = {{0, 0, 0}, {0, 0, 1}};
  for (const double spin : {1.0, 1e5}) {
    state.angular_velocity[1][2] = spin;
    audit::Audit audit(state, audit_setup(test::scene_of(2, 8), 1));
    audit.finish(1);
    EXPECT_TRUE(audit.findings().clean());
    EXPECT_EQ(audit.findings().checked, 1u);
    EXPECT_EQ(audit.findings().undecided, spin > 1 ? 1u : 0u);
  }
}

// --- Interruption.

TEST(Audit, GoesOnWhereItWasInterrupted_long) {
  Scene scene = test::inelastic(gas(50, 5), 0.7);
  EngineRun run(scene, 100);
  run.collisions[run.collisions.size() / 3].impulse[0] += 1e-6;  // to have something to remember
  const Findings whole = run.audited();
  for (const std::size_t at :
       {std::size_t{0}, std::size_t{1}, run.collisions.size() / 2, run.collisions.size()}) {
    audit::Audit first(run.initial, run.setup);
    for (std::size_t n = 0; n < at; ++n) first.add(run.collisions[n]);
    audit::Audit second(run.initial, run.setup);
    second.resume(first.checkpoint());
    for (const Collision& collision : run.collisions) second.add(collision);
    second.finish(run.end);
    EXPECT_EQ(listed(second.findings()), listed(whole));
  }
}

TEST(Audit, StoppedWhileItChecksTheLastFlightsIsAsBefore) {
  Scene scene = test::inelastic(gas(50, 5), 0.7);
  const EngineRun run(scene, 100);
  audit::Audit audit(run.initial, run.setup);
  for (const Collision& collision : run.collisions) audit.add(collision);
  const std::string before = listed(audit.findings());
  const std::size_t continued = audit.checkpoint().continuations.size();
  EXPECT_GT(continued, 0u);
  for (const int most : {1, 500}) {
    int asked = 0;
    EXPECT_FALSE(audit.finish(run.end, [&] { return ++asked == most; }));
    EXPECT_EQ(asked, most);
    EXPECT_EQ(listed(audit.findings()), before);
    EXPECT_EQ(audit.checkpoint().continuations.size(), continued);
  }
  EXPECT_TRUE(audit.finish(run.end, [] { return false; }));
  EXPECT_EQ(listed(audit.findings()), listed(run.audited()));
}

TEST(Audit, RefusesToGoOnWithAnotherRun) {
  const EngineRun run(gas(30, 1), 20);
  audit::Audit first(run.initial, run.setup);
  for (const Collision& collision : run.collisions) first.add(collision);
  audit::Audit second(run.initial, run.setup), third(run.initial, run.setup);
  second.resume(first.checkpoint());
  third.resume(first.checkpoint());
  EXPECT_THROW(
      {
        for (Collision collision : run.collisions) {
          collision.offset += 1e-14;
          second.add(collision);
        }
      },
      InputError);
  third.add(run.collisions[0]);
  EXPECT_THROW(third.finish(run.end), InputError);
}

}  // namespace
}  // namespace needlework::test
