// Sheared runs under the audit, which has images of its own.
#include <gtest/gtest.h>

#include "tests/support/audited.h"

namespace needlework {
namespace {

using test::audited;
using test::expect_clean;

Scene sheared(std::uint64_t count, double side, double rate, double offset) {
  Scene scene = test::scene_of(count, side, 3);
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc_relative = 0.02;
  scene.shear = Scene::Shear{rate, offset};
  return scene;
}

std::vector<std::pair<std::string, Scene>> scenes() {
  std::vector<std::pair<std::string, Scene>> out = {{"dilute", sheared(40, 4.5, 0.3, 1)},
                                                    {"dense", sheared(150, 3.2, -2, 2.5)},
                                                    {"fast", sheared(40, 2.2, 15, 0)}};
  out.push_back({"rough mixture", sheared(0, 5, 0.8, 0.3)});
  out.back().second.species = test::three_species();
  out.back().second.collisions.beta = 0.3;
  out.push_back({"rods and spheres", sheared(0, 4, 1.2, 1.7)});
  out.back().second.species = {
      {.name = "rods", .count = 30, .length = 1, .mass = 1, .k = 6, .diameter = 0.1},
      {.name = "spheres",
       .count = 20,
       .length = 0,
       .mass = 2,
       .k = 6,
       .t_rot = 0,
       .diameter = 0.6}};
  return out;
}

TEST(AuditOfShear, FindsNothingWrong) {
  for (const auto& [name, scene] : scenes()) {
    const audit::Findings findings =
        audited(scene, (name == "dilute" ? 30.0 : 3.0) / test::audit_share);
    expect_clean(findings, name);
    EXPECT_GT(findings.collisions, 30u / test::audit_share) << name;
  }
}

// Who knows another flow, or other images, finds collisions that are none.
TEST(AuditOfShear, SeesAnotherFlow) {
  const Scene scene = sheared(150, 3.2, -2, 2.5);
  const double epoch = Simulation(scene).epoch_length();
  audit::Setup other = test::audit_setup(scene, epoch);
  other.shear->rate = -2.0000001;
  EXPECT_GT(audited(scene, 1, other).count(audit::Kind::wrong_rule), 5u);
  other = test::audit_setup(scene, epoch);
  other.shear.reset();
  const audit::Findings findings = audited(scene, 1, other);
  EXPECT_GT(findings.count(audit::Kind::spurious), 5u);
  EXPECT_GT(findings.count(audit::Kind::missed), 5u);
}

TEST(AuditOfShear, RefusesWallsAndDriving) {
  Scene scene = sheared(40, 4.5, 0.3, 1);
  scene.driving.andersen = Scene::Andersen{};
  EXPECT_THROW(audited(scene, 0.1), InputError);
}

}  // namespace
}  // namespace needlework
