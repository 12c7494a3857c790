// A recorded run of needles that slide on each other.
#pragma once

#include <cmath>

#include "tests/support/audited.h"
#include "tests/support/recorded_run.h"

namespace needlework::test {

inline Scene sliding_gas(std::uint64_t count, double density, double epsilon) {
  Scene scene = scene_of(count, std::cbrt(static_cast<double>(count) / density));
  scene.collisions.epsilon = epsilon;
  scene.collisions.sliding = true;
  return scene;
}

struct SlidingRun : RecordedRun {
  SlidingContacts contacts;

  SlidingRun(const Scene& its_scene, double per_needle) : RecordedRun(its_scene) {
    Simulation simulation(scene);
    record(simulation, until_collisions(per_needle / audit_share));
    contacts = *simulation.sliding_contacts();
  }
};

}  // namespace needlework::test
