// One species of length 1 and mass 1 is the gas of needles.count, bit for bit, with or without the
// table of species.
#include <gtest/gtest.h>

#include <string>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/engine/initial_gas.h"
#include "src/engine/make_loop.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

const std::string rest = R"(
[collisions]
epsilon = 0.8
beta = -0.5
tc_relative = 1e-3
[until]
collisions_per_needle = 10
)";

std::string hash_of_species(const Scene& scene) {
  Simulation simulation(scene);
  EXPECT_EQ(simulation.advance(scene.until), Stop::collisions);
  return simulation.trajectory_hash();
}

TEST(OneSpecies, OfLengthAndMassOneIsTheGasOfNeedlesCount) {
  const std::string plain =
      "[needles]\ncount = 200\nbox = 6\nk = 2\nseed = 5\n[initial]\nt_tr = 1.5\nt_rot = 0.5\n" +
      rest;
  const std::string species =
      "[needles]\nbox = 6\nseed = 5\n[[species]]\nname = 'dumbbells'\n"
      "count = 200\nk = 2\nt_tr = 1.5\nt_rot = 0.5\n" +
      rest;
  const std::string hash = hash_of_species(parse_scene(plain, "plain.toml"));
  const Scene scene = parse_scene(species, "species.toml");
  EXPECT_EQ(hash_of_species(scene), hash);
  EXPECT_EQ(hash_of_species(parse_scene(
                species, "s.toml", std::vector<std::string>{"species.length=1", "species.mass=1"})),
            hash);
  EXPECT_NE(
      hash_of_species(parse_scene(species, "s.toml", std::vector<std::string>{"species.k=2.1"})),
      hash);
  EXPECT_FALSE(effects_of(scene).table);
}

// A scene made in code need not say twice what its species says.
TEST(OneSpecies, IsDrawnFromASceneMadeInCode) {
  Scene plain = test::scene_of(100, 5);
  plain.needles.k = 3;
  plain.initial.t_rot = 0.5;
  Scene scene = test::scene_of(0, 5);
  scene.species.emplace_back();
  scene.species[0].count = 100;
  scene.species[0].k = 3;
  scene.species[0].t_rot = 0.5;
  EXPECT_EQ(Simulation(scene).copy().velocity, Simulation(plain).copy().velocity);
  EXPECT_EQ(Simulation(scene).copy().angular_velocity, Simulation(plain).copy().angular_velocity);
}

}  // namespace
}  // namespace needlework
