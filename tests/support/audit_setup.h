// What the audit has to know of a scene.
#pragma once

#include "needlework/scene.h"
#include "src/audit/audit.h"

namespace needlework::test {

inline audit::Setup audit_setup(const Scene& scene, double epoch_length, double share = 1) {
  const auto& c = scene.collisions;
  audit::Setup setup;
  setup.epoch_length = epoch_length;
  setup.composition = scene.composition();
  setup.tc = c.tc;
  setup.tc_relative = c.tc_relative;
  setup.sliding = audit::sliding_of(scene);
  setup.walls = scene.walls;
  setup.gravity = scene.forces.gravity;
  setup.shear = scene.shear;
  setup.driving = scene.driving;
  setup.scene_seed = scene.needles.seed;
  setup.share = share;
  return setup;
}

}  // namespace needlework::test
