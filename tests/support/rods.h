// Scenes of rods of finite width.
#pragma once

#include <cmath>
#include <cstdint>

#include "needlework/scene.h"

namespace needlework::test {

/// One species of rods of diameter 1 and this length, at a packing fraction, in a cubic box.
inline Scene rods_of(std::uint64_t count, double length, double packing, std::uint64_t seed = 1) {
  Scene scene;
  scene.species = {{.name = "rods",
                    .count = count,
                    .length = length,
                    .k = length > 0 ? homogeneous_k(length, 1) : 6,
                    .diameter = 1}};
  scene.needles.seed = seed;
  const double volume = static_cast<double>(count) * scene.species[0].volume() / packing;
  const double edge = std::cbrt(volume);
  scene.needles.box = {edge, edge, edge};
  return scene;
}

/// Twice as many rods as spheres and longer, lighter rods, inelastic.
inline Scene rods_and_spheres(std::uint64_t spheres, double edge, std::uint64_t seed = 1) {
  Scene scene;
  scene.species = {{.name = "spheres", .count = spheres, .length = 0, .mass = 2, .diameter = 1.2},
                   {.name = "rods",
                    .count = 2 * spheres,
                    .length = 2,
                    .mass = 1,
                    .k = homogeneous_k(2, 0.8),
                    .t_rot = 0.5,
                    .diameter = 0.8}};
  scene.needles.seed = seed;
  scene.needles.box = {edge, edge, edge};
  scene.collisions.epsilon = 0.9;
  scene.collisions.tc = 1e-4;
  return scene;
}

}  // namespace needlework::test
