// The audit of rods of finite width: it finds nothing wrong with the engine, and all that is
// planted.
#include "tests/support/rods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "src/audit/audit.h"
#include "tests/support/audited.h"
#include "tests/support/by_build.h"
#include "tests/support/recorded_run.h"
#include "tests/support/runs.h"
#include "tests/support/scenes.h"

namespace needlework::test {
namespace {

using audit::Findings;
using audit::Kind;

constexpr int fewer = test::by_build(1, 10);

Scene rough_spheres(double beta) {
  Scene scene = test::inelastic(rods_of(100, 0, 0.3), 0.8);
  scene.species[0].given_inertia = 0.15;
  scene.collisions.beta = beta;
  return scene;
}

// Of spheres that are less rough, of another moment of inertia, or smooth within the contact time.
TEST(AuditOfRods, ReportsAnotherRoughness) {
  const auto wrong_rules = [](const Composition& composition) {
    RecordedRun run(rough_spheres(0.3), until_collisions(5.0 / fewer));
    run.setup.composition = composition;
    const Findings findings = run.audited();
    EXPECT_GT(findings.collisions, 50u / fewer);
    return static_cast<double>(findings.count(Kind::wrong_rule)) /
           static_cast<double>(findings.collisions);
  };
  Composition composition = rough_spheres(0.3).composition();
  EXPECT_EQ(wrong_rules(composition), 0);
  composition.set_restitution(0, 0, {0.8, 0.3 + 1e-9});
  EXPECT_GT(wrong_rules(composition), 0.9);
  composition = rough_spheres(0.3).composition();
  Species body = composition[0];
  body.q *= 1 + 1e-9;
  composition.set_species(0, body);
  EXPECT_GT(wrong_rules(composition), 0.9);
}

TEST(AuditOfRods, FindsNothingWrongWithTheEngine) {
  std::vector<Scene> scenes = {rods_of(150, 5, 0.3), rods_of(60, 5, 0.02), rods_of(100, 0, 0.3),
                               rods_and_spheres(30, 9), rods_of(60, 100, 4e-4)};
  scenes.emplace_back(test::inelastic(rods_of(60, 1, 0.2), 0.5));
  Scene& mixture = scenes.emplace_back(rods_and_spheres(30, 9));
  mixture.collisions.tc.reset();
  mixture.collisions.tc_relative = 1e-2;
  scenes.emplace_back(rough_spheres(0.3));
  Scene& rough_mixture = scenes.emplace_back(rods_and_spheres(30, 9));
  rough_mixture.pairs = {{.between = {"spheres", "spheres"}, .epsilon = 0.8, .beta = -0.3}};
  Scene& walled = scenes.emplace_back(rods_of(60, 2, 0.05));
  walled.walls = {{.axis = "z", .side = "both", .epsilon = 0.9}};
  walled.forces.gravity = {0, 0, -1};
  std::uint64_t escalated = 0;
  for (const Scene& scene : scenes) {
    const RecordedRun run(scene, until_collisions(5.0 / fewer));
    const Findings findings = run.audited();
    EXPECT_TRUE(findings.clean()) << name_of(scene) << ": " << listed(findings);
    EXPECT_EQ(findings.undecided, 0u) << name_of(scene);
    ASSERT_TRUE(findings.overlaps);
    // Rounding; none at all would be too good to be true.
    const std::array<double, 3>& box = scene.needles.box;
    EXPECT_GT(findings.overlaps->at_collisions, 0) << name_of(scene);
    EXPECT_LT(findings.overlaps->at_collisions, 1e-13) << name_of(scene);
    EXPECT_GT(findings.overlaps->at_most, 1e-13) << name_of(scene);
    EXPECT_LT(findings.overlaps->at_most, 1e-13 + 0x1p-48 * (box[0] + box[1] + box[2]))
        << name_of(scene);
    EXPECT_EQ(findings.contacts, findings.collisions);
    EXPECT_GT(findings.contacts, 50u / fewer);
    escalated += findings.escalated;
  }
  EXPECT_GT(escalated, 0u);
}

/// Rods of this length that may grow.
struct Rods {
  double length = 0, growth = 0;

  Scene scene() const {
    Scene out = rods_of(length < 5 ? 50 : 130, length, 0.25);
    if (growth > 0) out.driving.growth = Scene::Growth{.rate = growth, .cool_every = 0.25};
    return out;
  }
};

class FalseReportOfRods : public testing::TestWithParam<Rods> {
 protected:
  FalseReportOfRods()
      : run(GetParam().scene(), until_collisions(10.0 / fewer)), n(run.happenings.size() / 2) {}
  Collision& victim() { return run.happenings[n].event; }
  std::uint64_t count(Kind kind) const { return run.audited().count(kind); }
  template <class Alter>
  std::uint64_t altered(Kind kind, const Alter& alter) {
    const Collision kept = victim();
    alter(victim());
    const std::uint64_t found = count(kind);
    victim() = kept;
    return found;
  }

  RecordedRun run;
  std::size_t n;
};

TEST_P(FalseReportOfRods, OfACollisionLeftOutIsSeen) {
  run.leave_out(n);
  EXPECT_GE(count(Kind::missed), 1u);
}

TEST_P(FalseReportOfRods, OfACollisionThatWasNotIsSeen) {
  Happening invented = run.happenings[n];
  invented.event.offset -= 1e-4;
  invented.event.time -= 1e-4;
  while (n > 0 && invented.event.time < run.happenings[n - 1].event.time) --n;
  run.insert(n, invented);
  const Findings findings = run.audited();
  EXPECT_GE(findings.count(Kind::spurious) + findings.count(Kind::early), 1u);
  EXPECT_GE(findings.count(Kind::wrong_rule), 1u);
}

// Rods that have just collided part.
TEST_P(FalseReportOfRods, OfACollisionAgainIsSeen) {
  Happening again = run.happenings[n];
  again.event.offset += 0x1p-50;
  run.insert(n + 1, again);
  EXPECT_GE(count(Kind::spurious), 1u);
}

TEST_P(FalseReportOfRods, OfTheTimeIsSeen) {
  EXPECT_GE(altered(Kind::late, [](Collision& c) { c.offset += 1e-9; }), 1u);
  EXPECT_GE(altered(Kind::early, [](Collision& c) { c.offset -= 1e-9; }), 1u);
  // By what rounding does not explain.
  EXPECT_GE(altered(Kind::late, [](Collision& c) { c.offset += 4e-12; }), 1u);
}

TEST_P(FalseReportOfRods, OfAnyNumberIsSeen) {
  const auto wrong = [&](auto&& alter) { return altered(Kind::wrong_rule, alter); };
  EXPECT_EQ(count(Kind::wrong_rule), 0u);
  EXPECT_EQ(wrong([](Collision& c) { c.arm_first += 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.arm_second -= 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.sin_angle += 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.shift[0] += 1; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.normal_velocity *= 1 + 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.impulse[1] += 1e-10; }), 1u);
  EXPECT_EQ(wrong([](Collision& c) { c.energy_change += 1e-10; }), 1u);
  EXPECT_GE(wrong([](Collision& c) { c.after[0].position[2] += 1e-10; }), 1u);
  EXPECT_GE(wrong([](Collision& c) { c.after[1].velocity[0] += 1e-10; }), 1u);
  EXPECT_GE(wrong([](Collision& c) { c.after[0].angular_velocity[1] += 1e-10; }), 1u);
}

TEST_P(FalseReportOfRods, OfOtherRodsIsSeen) {
  const auto found = [&](Kind kind, auto&& alter) {
    std::vector<Species> species = run.setup.composition.species();
    alter(species[0]);
    RecordedRun other = run;
    other.setup.composition = Composition(species, {});
    other.initial.own_bodies = {};  // which say it again where bodies grow
    return other.audited().count(kind);
  };
  EXPECT_GT(found(Kind::late, [](Species& rod) { rod.diameter *= 1 + 1e-6; }), 0u);
  // Smaller spheres are not even within reach where they have collided.
  const bool are_spheres = GetParam().length == 0;
  const Kind too_soon = are_spheres ? Kind::spurious : Kind::early;
  EXPECT_GT(found(too_soon, [](Species& rod) { rod.diameter *= 1 - 1e-6; }), 0u);
  if (are_spheres) return;
  EXPECT_GT(found(Kind::wrong_rule, [](Species& rod) { rod.k *= 1 + 1e-8; }), 0u);
  EXPECT_GT(found(Kind::missed, [](Species& rod) { rod.length *= 1.01; }), 0u);
}

std::string name_of_rods(const testing::TestParamInfo<Rods>& info) {
  return std::string(info.param.growth > 0 ? "Growing" : "") +
         (info.param.length == 0 ? "Spheres" : "Rods");
}

INSTANTIATE_TEST_SUITE_P(SpheresAndRods, FalseReportOfRods,
                         testing::Values(Rods{0}, Rods{5}, Rods{0, 0.05}, Rods{2, 0.05}),
                         name_of_rods);

}  // namespace
}  // namespace needlework::test
