// Mixtures: several species in one gas.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "tests/engine/effect_scenes.h"
#include "tests/support/scenes.h"

namespace needlework {
namespace {

Scene mixture() { return test::effect_scene("mixture"); }

// One species, told as two, has the same trajectory to the last bit, though another loop follows
// it.
TEST(Mixture, OfOneSpeciesTwiceIsThatSpecies) {
  for (const bool cools : {false, true}) {
    Scene one = test::scene_of(200, 6, 5);
    one.initial.t_rot = 0.4;
    one.needles.k = 3;
    if (cools) one.collisions = {.epsilon = 0.8, .beta = 0.3, .tc = 1e-4, .tc_relative = {}};
    Scene two = one;
    const Species half{
        .name = "a", .count = 80, .length = 1, .mass = 1, .k = 3, .t_tr = 1, .t_rot = 0.4};
    two.species = {half, half};
    two.species[1].name = "b";
    two.species[1].count = 120;
    const State drawn_one = draw_initial_state(one), drawn_two = draw_initial_state(two);
    ASSERT_EQ(drawn_one.velocity, drawn_two.velocity);
    ASSERT_EQ(drawn_one.angular_velocity, drawn_two.angular_velocity);
    Simulation a(one), b(two);
    a.advance(test::until_time(12));
    b.advance(test::until_time(12));
    EXPECT_GT(a.collisions(), 500u);
    EXPECT_EQ(a.trajectory_hash(), b.trajectory_hash());
    const auto by_pair = b.collisions_by_pair();
    ASSERT_EQ(by_pair.size(), 3u);
    EXPECT_EQ(std::accumulate(by_pair.begin(), by_pair.end(), std::uint64_t{0}), b.collisions());
    EXPECT_EQ(a.collisions_by_pair(), std::vector{a.collisions()});
    for (const char* search : {"all-pairs", "linked-lists", "linked-cells", "capsules"}) {
      EXPECT_EQ(test::hash_of(test::searched_by(two, search), test::until_time(12)),
                a.trajectory_hash())
          << search;
    }
  }
}

// Masses, lengths and restitution of each collision, as its report has them, are those of its
// needles.
TEST(Mixture, CollidesByTheRuleOfEachPair) {
  const Scene scene = mixture();
  const Composition composition = scene.composition();
  const State drawn = draw_initial_state(scene);
  std::vector<std::array<double, 3>> velocity = drawn.velocity;
  std::vector<std::uint64_t> seen(composition.pairs());
  const auto recorded = test::record(scene, drawn, 3000);
  for (const Collision& c : recorded.collisions) {
    const std::size_t a = drawn.species[c.first], b = drawn.species[c.second];
    ++seen[composition.pair_index(a, b)];
    EXPECT_LT(std::abs(c.arm_first), composition[a].length / 2);
    EXPECT_LT(std::abs(c.arm_second), composition[b].length / 2);
    for (int axis = 0; axis < 3; ++axis) {
      const double gained = c.after[0].velocity[axis] - velocity[c.first][axis];
      const double lost = velocity[c.second][axis] - c.after[1].velocity[axis];
      EXPECT_NEAR(gained * composition[a].mass, c.impulse[axis],
                  1e-12 * (1 + std::abs(c.impulse[axis])));
      EXPECT_NEAR(lost * composition[b].mass, c.impulse[axis],
                  1e-12 * (1 + std::abs(c.impulse[axis])));
    }
    velocity[c.first] = c.after[0].velocity;
    velocity[c.second] = c.after[1].velocity;
    const Restitution& rule = composition.restitution(a, b);
    // The normal part alone bounds the loss from below.
    const double mass = 1 / composition[a].mass + 1 / composition[b].mass +
                        c.arm_first * c.arm_first / composition[a].inertia() +
                        c.arm_second * c.arm_second / composition[b].inertia();
    const double epsilon = c.contact_time_rule ? 1 : rule.epsilon;
    const double normal =
        -0.5 * (1 - epsilon * epsilon) * c.normal_velocity * c.normal_velocity / mass;
    const bool smooth = c.contact_time_rule || rule.beta == -1;
    if (smooth) {
      EXPECT_NEAR(c.energy_change, normal, 1e-12 * (1 + std::abs(normal)));
    } else {
      EXPECT_LT(c.energy_change, normal + 1e-12);
    }
  }
  for (const std::uint64_t count : seen) EXPECT_GT(count, 0u);
}

TEST(Mixture, IsDrawnWithTheEnergiesOfItsSpecies) {
  Scene scene = mixture();
  for (Species& each : scene.species) each.count *= 100;
  for (double& edge : scene.needles.box) edge *= 5;
  Simulation simulation(scene);
  const Totals totals = simulation.totals();
  const auto by_species = simulation.species_totals();
  double t_tr = 0, t_rot = 0, count = 0;
  for (std::size_t n = 0; n < scene.species.size(); ++n) {
    const Species& species = scene.species[n];
    const double number = static_cast<double>(species.count);
    EXPECT_EQ(by_species[n].count, species.count);
    // Of 3 N and 2 N squares, 5 standard errors.
    EXPECT_NEAR(by_species[n].t_tr / species.t_tr, 1, 5 * std::sqrt(2 / (3 * number)));
    EXPECT_NEAR(by_species[n].t_rot / species.t_rot, 1, 5 * std::sqrt(1 / number));
    t_tr += number * species.t_tr;
    t_rot += number * species.t_rot;
    count += number;
  }
  EXPECT_NEAR(totals.t_tr, t_tr / count, 1e-12);
  EXPECT_NEAR(totals.t_rot, t_rot / count, 1e-12);
  for (const double p : totals.momentum) EXPECT_NEAR(p, 0, 1e-9);
}

// Ids need not be in the order of the species.
TEST(Mixture, IsStartedFromAStateWithSpeciesInAnyOrder) {
  const Scene scene = mixture();
  State state = draw_initial_state(scene);
  const auto ordered = test::record(scene, state, 500);
  const std::size_t count = state.size();
  State mixed = state;
  mixed.resize(count);
  for (std::size_t row = 0; row < count; ++row) {
    const std::size_t from = (row * 7 + 3) % count;  // coprime
    mixed.position[row] = state.position[from];
    mixed.velocity[row] = state.velocity[from];
    mixed.orientation[row] = state.orientation[from];
    mixed.angular_velocity[row] = state.angular_velocity[from];
    mixed.species[row] = state.species[from];
    mixed.id[row] = static_cast<std::uint32_t>(from);
  }
  EXPECT_EQ(test::record(scene, mixed, 500).hash, ordered.hash);
  mixed.species[0] = mixed.species[0] == 0 ? 1 : 0;
  EXPECT_THROW(Simulation(scene, mixed), InputError);
  mixed.species[0] = 3;
  EXPECT_THROW(Simulation(scene, mixed), InputError);
  state.species.pop_back();
  EXPECT_THROW(Simulation(scene, state), InputError);
}

}  // namespace
}  // namespace needlework
