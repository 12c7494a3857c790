// Small runs for tests: scenes made in code, their collisions recorded, their states transformed.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"

namespace needlework::test {

/// A scene of `count` needles in a cubic box of this side, equilibrium temperatures, elastic.
inline Scene scene_of(std::uint64_t count, double side, std::uint64_t seed = 1) {
  Scene scene;
  scene.needles.count = count;
  scene.needles.box = {side, side, side};
  scene.needles.seed = seed;
  return scene;
}

/// The same scene for needles of this length and mass: the box grows with the length, k, count and
/// temperatures stay. Times are then in length * sqrt(mass) times what they were.
inline Scene with_species(Scene scene, double length, double mass) {
  const Scene::Needles& needles = scene.needles;
  scene.species = {{.name = "needles",
                    .count = needles.count,
                    .length = length,
                    .mass = mass,
                    .k = needles.k,
                    .t_tr = scene.initial.t_tr,
                    .t_rot = scene.initial.t_rot}};
  for (double& edge : scene.needles.box) edge *= length;
  return scene;
}

/// One line that says which scene a failing test ran.
inline std::string name_of(const Scene& scene) {
  const auto& c = scene.collisions;
  return std::to_string(scene.needles.count) + " needles, box " +
         std::to_string(scene.needles.box[0]) + ", epsilon " + std::to_string(c.epsilon) +
         ", beta " + std::to_string(c.beta) + ", T_rot " + std::to_string(scene.initial.t_rot) +
         ", seed " + std::to_string(scene.needles.seed);
}

inline Scene::Until until_time(double time) {
  Scene::Until until;
  until.time = time;
  return until;
}

inline Scene::Until until_collisions(double per_needle) {
  Scene::Until until;
  until.collisions_per_needle = per_needle;
  return until;
}

/// That a run goes on from its checkpoint at `saved` as one that was not interrupted, until `end`,
/// and that a run of another scene does not.
inline void expect_to_continue(const Scene& scene, double saved, double end, const Scene& other) {
  Simulation whole(scene), half(scene);
  whole.advance(until_time(end));
  half.advance(until_time(saved));
  Simulation rest(scene, half.checkpoint());
  rest.advance(until_time(end));
  EXPECT_EQ(rest.trajectory_hash(), whole.trajectory_hash());
  EXPECT_EQ(rest.virial(), whole.virial());
  EXPECT_EQ(rest.t_tr_integral(), whole.t_tr_integral());
  EXPECT_THROW(Simulation(other, half.checkpoint()), InputError);
}

struct Recorded {
  std::vector<Collision> collisions;
  State end;
  Totals totals;
  std::string hash;
  double epoch_length;
};

/// A simulation from its start, a state or a checkpoint, and its collisions.
struct Followed {
  template <class... Start>
  explicit Followed(const Scene& scene, const Start&... start) : simulation(scene, start...) {
    simulation.on_collision([this](const Collision& c) { collisions.push_back(c); });
  }
  Followed(const Followed&) = delete;
  Followed& operator=(const Followed&) = delete;

  /// Until the run has had so many collisions in all.
  void advance_to_collision(double n) {
    simulation.advance(until_collisions(2 * n / static_cast<double>(simulation.needles())));
  }
  Recorded recorded() const {
    return {collisions, simulation.copy(), simulation.totals(), simulation.trajectory_hash(),
            simulation.epoch_length()};
  }
  Simulation* operator->() { return &simulation; }
  const Simulation* operator->() const { return &simulation; }
  Simulation& operator*() { return simulation; }

  Simulation simulation;
  std::vector<Collision> collisions;
};

/// Runs for `count` collisions from a state, recording each.
inline Recorded record(const Scene& scene, const State& initial, double count) {
  Followed run(scene, initial);
  run.advance_to_collision(count);
  return run.recorded();
}

inline Recorded record(const Scene& scene, double count) {
  return record(scene, draw_initial_state(scene), count);
}

}  // namespace needlework::test
