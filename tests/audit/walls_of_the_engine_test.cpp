// The audit finds nothing wrong with hits of the engine on walls, under gravity and a thermostat.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/audited.h"
#include "tests/support/rods.h"
#include "tests/support/wall.h"

namespace needlework::test {
namespace {

using audit::Findings;

// Whether the audit finds nothing, in a gas with hits and collisions enough.
void expect_clean_gas(const Scene& scene) {
  const Findings findings = audited(scene, 10.0 / audit_share);
  expect_clean(findings, name_of(scene));
  EXPECT_GT(findings.hits, 100u / audit_share);
  EXPECT_GT(findings.contacts, 50u / audit_share);
}

TEST(AuditOfWalls, FindsNothingWrongWithTheEngineBetweenWalls) {
  Scene elastic = scene_of(80, 4);
  elastic.walls = {wall("z", "both")};
  Scene cooling = scene_of(80, 4);
  cooling.walls = {wall("x", "both", 0.8), wall("y", "low", 0.9), wall("y", "high")};
  cooling.collisions.epsilon = 0.9;
  cooling.collisions.tc = 1e-4;
  for (const Scene& scene : {elastic, cooling}) expect_clean_gas(scene);
}

TEST(AuditOfWalls, FindsNothingWrongWithGravityAndMotion) {
  Scene falling = scene_of(60, 4);
  falling.walls = {wall("z", "low")};
  falling.forces.gravity = {0, 0, -1};
  Scene vibrated = falling;
  vibrated.walls[0].epsilon = 0.9;
  vibrated.walls[0].motion = Scene::WallMotion{.amplitude = 0.1, .frequency = 1.3, .phase = 0.7};
  vibrated.collisions.epsilon = 0.9;
  vibrated.collisions.beta = 0.2;
  vibrated.collisions.tc = 1e-4;
  // Up, where heights above the low edge give energies below 0.
  Scene rising = falling;
  rising.walls[0].side = "high";
  rising.forces.gravity = {0, 0, 3};
  Scene channel = scene_of(60, 4);
  channel.walls = {wall("z", "both")};
  channel.walls[0].temperature = 1;
  channel.forces.gravity = {2, -1, 0};
  channel.collisions = vibrated.collisions;
  for (const Scene& scene : {falling, vibrated, rising, channel}) expect_clean_gas(scene);
}

TEST(AuditOfWalls, FindsNothingWrongWithPistonsAndBelts) {
  Scene needles = scene_of(60, 4);
  needles.needles.box[2] = 8;
  needles.walls = {piston("z", "low", 0.15, 1.2), piston("z", "high", -0.3, 5.0, 0.9)};
  needles.collisions.epsilon = 0.9;
  needles.collisions.tc = 1e-4;
  Scene receding = scene_of(60, 4);
  receding.walls = {piston("y", "low", -3, -2.0), piston("y", "high", 0.05, {}, 0.8)};
  receding.forces.gravity = {0, 0.4, 0};
  Scene rods = rods_and_spheres(25, 8, 2);
  rods.walls = {piston("x", "both", 0.7), piston("z", "high", -0.3, 5.5)};
  rods.walls.push_back(wall("z", "low"));
  Scene belts = scene_of(60, 4);
  belts.walls = {belt("z", "low", 1, 2, -1), belt("z", "high", 0.5, -1)};
  belts.forces.gravity = {0, 0.5, 0};
  for (const Scene& scene : {needles, receding, rods, belts}) expect_clean_gas(scene);
}

// Spheres that fly hundreds of edges away through an open side, where their places round more.
TEST(AuditOfWalls, FindsNothingWrongFarBeyondAnOpenSide) {
  Scene scene = scene_of(0, 1.1913356440626408);
  scene.needles.seed = 120351;
  scene.collisions.tc_relative = 1e-3;
  scene.forces.gravity = {-5.8387874128203645, -0.08820100583697889, 0.09529989198858446};
  constexpr double length = 0.41997844600874484, diameter = 0.23791376005033193;
  scene.species = {{.name = "rods",
                    .count = 3,
                    .length = length,
                    .k = homogeneous_k(length, diameter),
                    .t_rot = 0,
                    .diameter = diameter}};
  scene.walls = {wall("y", "low", 0.99), wall("x", "low"), wall("z", "low"),
                 wall("z", "high", 0.5)};
  scene.walls[1].motion = Scene::WallMotion{
      .amplitude = 0.006578922060590769, .frequency = 1.7212141938726504, .phase = 0};
  scene.walls[2].temperature = 1;
  const Findings findings = audited(scene, 195.0 / audit_share);
  expect_clean(findings, name_of(scene));
  EXPECT_GT(findings.hits, 8000u / audit_share);
}

TEST(AuditOfWalls, FindsNothingWrongWithThermalWallsAndMixtures) {
  Scene scene = scene_of(0, 4);
  scene.species = {{.name = "short", .count = 50, .length = 0.6, .mass = 0.5, .k = 4},
                   {.name = "long", .count = 12, .length = 1.5, .mass = 7, .k = 6, .t_tr = 0.3}};
  scene.walls = {wall("z", "low"), wall("z", "high")};
  scene.walls[0].temperature = 2;
  const Findings findings = audited(scene, 10.0 / audit_share);
  expect_clean(findings, "a mixture");
  EXPECT_GT(findings.hits, 50u / audit_share);
}

}  // namespace
}  // namespace needlework::test
