// What the tests of replaced velocities share: velocities to set, the parts of the engine to set
// them with, and what follows.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "needlework/simulation.h"
#include "src/calendar/names.h"
#include "tests/support/random.h"
#include "tests/support/runs.h"
#include "tests/support/same_run.h"
#include "tests/support/scenes.h"

namespace needlework::test {

using Rows = std::vector<std::array<double, 3>>;

inline Rows times(double factor, Rows rows) {
  for (auto& row : rows) {
    for (double& x : row) x *= factor;
  }
  return rows;
}

/// All velocities of the present state, times a factor.
inline void scale_velocities(Simulation& simulation, double factor) {
  const State state = simulation.copy();
  simulation.set_velocities(times(factor, state.velocity), times(factor, state.angular_velocity));
}
inline void reverse(Simulation& simulation) { scale_velocities(simulation, -1); }

/// New ones, of temperature 1 and k = 6.
inline void draw_velocities(Simulation& simulation, std::uint64_t seed) {
  Random random(seed);
  Rows velocity, angular_velocity;
  for (std::size_t n = 0; n < simulation.copy().size(); ++n) {
    velocity.push_back(random.normal_vector(1));
    angular_velocity.push_back(random.normal_vector(std::sqrt(12.0)));
  }
  simulation.set_velocities(velocity, angular_velocity);
}

/// Up to the collision of this number.
inline Scene::Until until_collision(double number, double needles) {
  return until_collisions(2 * (number - 0.5) / needles);
}

struct Parts {
  std::string search, calendar;
  int threads = 1;

  std::string name() const {
    return search + ", " + calendar + ", threads " + std::to_string(threads);
  }
  Scene of(Scene scene) const {
    scene.engine.search = search;
    scene.engine.queue = calendar;
    return on_threads(scene, threads);
  }
};

/// Every search, with every calendar in turn, and several threads; all-pairs first.
inline std::vector<Parts> all_parts() {
  std::vector<Parts> out;
  const std::vector<std::string>& calendars = calendar_names();
  std::size_t n = 0;
  for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
    for (int times = 0; times < 2; ++times)
      out.push_back({search, calendars[n++ % calendars.size()]});
  }
  for (const char* search : {"linked-cells", "capsules"}) {
    for (const int threads : {2, 3}) out.push_back({search, "cell-calendar", threads});
  }
  return out;
}

/// What is done and seen with one choice of parts is the same with all.
inline void expect_same_with_all_parts(const Scene& scene,
                                       const std::function<Recorded(const Scene&)>& run) {
  const std::vector<Parts> parts = all_parts();
  const Recorded truth = run(parts.front().of(scene));
  for (const Parts& other : parts) {
    SCOPED_TRACE(other.name());
    ASSERT_NO_FATAL_FAILURE(expect_same(truth, run(other.of(scene))));
  }
}

/// The last `count` collisions of a run happen again in the reverse order, seen from `turned`, when
/// all velocities are reversed. The first may be at that very time.
inline void expect_retraced(const std::vector<Collision>& forth, const std::vector<Collision>& back,
                            double turned, double rested = 0) {
  ASSERT_EQ(back.size(), forth.size());
  for (std::size_t n = 0; n < back.size(); ++n) {
    const Collision &b = back[n], &f = forth[forth.size() - 1 - n];
    ASSERT_TRUE(b.first == f.first && b.second == f.second) << "collision " << n << " back";
    ASSERT_NEAR(b.time - turned - rested, turned - f.time, 1e-7) << "collision " << n << " back";
    // It was the velocity of approach, and of separation but for its sign.
    ASSERT_NEAR(b.normal_velocity, f.normal_velocity, 1e-6) << "collision " << n << " back";
    ASSERT_NEAR(b.arm_first, f.arm_first, 1e-6) << "collision " << n << " back";
  }
}

}  // namespace needlework::test
