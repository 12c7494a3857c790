// Scenes changed in one expression, and where they lead.
#pragma once

#include <string>

#include "tests/support/runs.h"

namespace needlework::test {

/// With this collision rule; a relative contact time of 0 is none.
inline Scene inelastic(Scene scene, double epsilon, double tc_relative = 1e-3, double beta = -1) {
  scene.collisions.epsilon = epsilon;
  scene.collisions.beta = beta;
  if (tc_relative > 0) scene.collisions.tc_relative = tc_relative;
  return scene;
}

/// On so many threads, which share the work also where one alone would be faster.
inline Scene on_threads(Scene scene, int threads) {
  scene.engine.threads = threads;
  scene.engine.team = "all";
  return scene;
}

inline Scene searched_by(Scene scene, const char* search) {
  scene.engine.search = search;
  return scene;
}

/// Of a run from the drawn state.
inline std::string hash_of(const Scene& scene, const Scene::Until& until) {
  Simulation simulation(scene);
  simulation.advance(until);
  return simulation.trajectory_hash();
}

}  // namespace needlework::test
