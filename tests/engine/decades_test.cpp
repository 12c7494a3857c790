// Lengths, masses, inertias, temperatures and boxes of all decades: what searches cannot follow is
// refused, whoever gives it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/parse.h"
#include "needlework/simulation.h"
#include "tests/support/random.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

using Rows = std::vector<std::array<double, 3>>;

Scene scene_with(const Scene::Species& species, double side) {
  Scene scene = test::scene_of(species.count, side);
  scene.species = {species};
  scene.needles.k = species.k;
  return scene;
}

// The error of what a function does; empty if there is none.
std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

double decade(test::Random& random, double from, double to) {
  return random.coin() ? random.log_uniform(from, to)
                       : random.log_uniform(std::sqrt(from), std::sqrt(to));
}

double temperature(test::Random& random) {
  return random.below(8) == 0 ? 0 : decade(random, 1e-200, 1e200);
}

// A cloud of some needle lengths in a box of any size.
State cloud_of(const Scene& scene, double box) {
  Scene unit = scene;  // drawn at temperatures that can always be drawn
  Scene::Species& species = unit.species.front();
  species.length = species.mass = species.t_tr = species.t_rot = 1;
  unit.needles.box.fill(3);
  State state = draw_initial_state(unit);
  const Scene::Species& asked = scene.species.front();
  const double v = std::sqrt(asked.t_tr / asked.mass),
               w = std::sqrt(asked.t_rot / asked.mass) / asked.length;
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      state.position[i][axis] *= asked.length;
      state.velocity[i][axis] *= v;
      state.angular_velocity[i][axis] *= w;
    }
  }
  state.box.fill(box);
  return state;
}

// What a run gives, or why there is none.
struct Outcome {
  std::string text;
  std::uint64_t collisions = 0;
  bool refused = false;
};

Outcome outcome_of(Scene scene, const State& state, const std::string& search, double time) {
  scene.engine.search = search;
  try {
    Simulation simulation(scene, state);
    Scene::Until until;
    until.time = time;
    until.collisions_per_needle = 6;
    until.wall_s = 60;
    std::string end;
    try {
      end = simulation.advance(until) == Stop::wall_time ? "without end" : "ended";
    } catch (const InvalidStateError& error) {
      end = error.what();
    }
    return {fmt::format("{} {} {}", simulation.trajectory_hash(), simulation.collisions(), end),
            simulation.collisions(), false};
  } catch (const InputError& error) {
    return {error.what(), 0, true};
  }
}

TEST(AllDecades, AreRefusedOrTheSameInAllSearches) {
  test::Random random(1139);
  int refused = 0, collided = 0;
  for (int n = 0; n < 200; ++n) {
    Scene::Species species;
    species.name = "a";
    species.count = 2 + random.below(20);
    species.length = decade(random, 1e-6, 1e6);
    species.mass = decade(random, 1e-100, 1e100);
    species.k = decade(random, 1e-9, 1e9);
    species.t_tr = temperature(random);
    species.t_rot = temperature(random);
    const double in_lengths = random.coin() ? 3 : random.log_uniform(3, 1e6);
    const Scene scene = scene_with(species, 3 * species.length);
    const State state = cloud_of(scene, std::min(in_lengths * species.length, 1e9));
    // Collisions may turn flight into rotation, which is faster for large k.
    const double rate = std::sqrt(std::max(species.t_tr, species.t_rot) / species.mass) *
                        (1 + std::sqrt(4 * species.k)) / species.length;
    const double time = rate > 0 ? 4 / rate : 1;
    const Outcome truth = outcome_of(scene, state, "all-pairs", time);
    refused += truth.refused;
    collided += truth.collisions > 0;
    for (const char* search : {"linked-lists", "linked-cells", "capsules"}) {
      ASSERT_EQ(outcome_of(scene, state, search, time).text, truth.text)
          << search << ", n " << n << ": count " << species.count << ", length " << species.length
          << ", mass " << species.mass << ", k " << species.k << ", t_tr " << species.t_tr
          << ", t_rot " << species.t_rot << ", box " << state.box[0];
    }
    ASSERT_FALSE(truth.text.ends_with("without end")) << n;
  }
  std::printf("%d refused, %d with collisions\n", refused, collided);
  EXPECT_GT(refused, 20);
  EXPECT_GT(collided, 40);
}

// Needles so small and fast that the square of their speed in lengths has no double.
TEST(AllDecades, AreRefusedByEachEntry) {
  const Scene::Species fast{"a", 40, 1e-4, 1e-100, 6, 1e200, 0};
  const Scene scene = scene_with(fast, 4e-4);
  Scene slow = scene;
  slow.species.front().t_tr = 1;
  const State state = draw_initial_state(slow);
  Rows velocity = state.velocity;
  for (auto& row : velocity) {
    for (double& component : row) component *= 1e100;
  }
  State hot = state;
  hot.velocity = velocity;
  const std::string reason =
      "a square of the largest possible speed of 1.2e+302: expected at most ";

  const auto expect = [&](const std::string& place, const std::function<void()>& act) {
    const std::string message = refusal(act);
    EXPECT_TRUE(message.starts_with(place + reason)) << message;
  };
  expect("scene.toml: its needles and temperatures give ", [&] {
    parse_scene(
        "needles.box = 4e-4\nuntil.time = 1\n[[species]]\nname = \"a\"\ncount = 40\n"
        "length = 1e-4\nmass = 1e-100\nt_tr = 1e200\nt_rot = 0\n",
        "scene.toml");
  });
  expect("the scene: its needles and temperatures give ", [&] { Simulation{scene}; });
  expect("state: ", [&] { Simulation(scene, hot); });
  expect("state: ", [&] { require_simulable(scene, hot); });
  Simulation simulation(slow);
  expect("set_velocities: ", [&] { simulation.set_velocities(velocity, Rows(velocity.size())); });
}

// 2^31 of them are too many to count.
TEST(AllDecades, OfPositionsInBoxesAreRefused) {
  const Scene scene = test::scene_of(2, 4);
  State state = draw_initial_state(scene);
  state.position[1][2] = 1e15;
  EXPECT_EQ(refusal([&] { require_simulable(scene, state); }),
            "state: needle 1: position 1000000000000000 in a box of 4, with image 0: expected it "
            "within 2147481599 boxes");
}

TEST(AllDecades, OfSlowNeedlesAreRefusedBeforeTheirSquaresVanish) {
  const Scene scene = test::scene_of(20, 3);
  State state = draw_initial_state(scene);
  for (auto* rows : {&state.velocity, &state.angular_velocity}) {
    for (auto& row : *rows) {
      for (double& component : row) component *= 1e-170;
    }
  }
  EXPECT_TRUE(refusal([&] { Simulation(scene, state); }).starts_with("state: an energy of "));
  Simulation simulation(scene);
  EXPECT_TRUE(refusal([&] {
                simulation.set_velocities(state.velocity, state.angular_velocity);
              }).starts_with("set_velocities: an energy of "));
}

}  // namespace
}  // namespace needlework
