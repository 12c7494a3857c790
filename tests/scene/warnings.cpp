// Warnings about valid scenes: each is given when it should be, and not otherwise.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "needlework/parse.h"
#include "src/scene/check.h"
#include "tests/support/contains.h"

namespace needlework {
namespace {

std::vector<std::string> warnings_of(const std::string& more) {
  return warnings(parse_scene("needles.count = 10\nneedles.box = 4\n" + more, "s.toml"));
}

// The keys that a scene's warnings begin with.
std::vector<std::string> warned_of(const std::string& more) {
  std::vector<std::string> keys;
  for (const std::string& w : warnings_of(more)) keys.push_back(w.substr(0, w.find_first_of(" :")));
  return keys;
}

using Keys = std::vector<std::string>;

TEST(Warning, IsNotGivenForOrdinaryScenes) {
  EXPECT_EQ(warned_of("until.time = 1"), Keys{});
  EXPECT_EQ(warned_of("until.energy_ratio = 1e-3\n[collisions]\nepsilon = 0.8\ntc_relative = 1e-4"),
            Keys{});
  EXPECT_EQ(warned_of("until.time = 5\n[output]\nfile = 'a.h5'\nframes = [0, 5]\nevents = true"),
            Keys{});
}

TEST(Warning, NamesTcRelativeForInelasticNeedlesWithoutIt) {
  const auto list = warnings_of("until.time = 1\ncollisions.epsilon = 0.8");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_TRUE(list[0].starts_with("collisions.epsilon = 0.8: ")) << list[0];
  EXPECT_TRUE(test::contains(list[0], "collisions.tc_relative"));
  EXPECT_EQ(warned_of("until.time = 1\ncollisions = {epsilon = 0.8, tc = 0}"),
            Keys{"collisions.epsilon"});
  EXPECT_EQ(warned_of("until.time = 1\ncollisions.beta = 0"), Keys{});
}

TEST(Warning, CallsBodiesByTheirName) {
  const auto warning_of = [](const std::string& species) {
    const auto list =
        warnings(parse_scene("until.time = 1\nneedles.box = 9\n"
                             "collisions.epsilon = 0.8\n" +
                                 species,
                             "s.toml"));
    return list.empty() ? "none" : list[0];
  };
  const std::string entry = "[[species]]\ncount = 5\nname = ",
                    sphere = "length = 0\ndiameter = 1\n";
  EXPECT_TRUE(test::contains(warning_of(entry + "'a'\n"), ": inelastic needles can"));
  EXPECT_TRUE(test::contains(warning_of(entry + "'a'\n" + sphere), ": inelastic spheres can"));
  EXPECT_TRUE(test::contains(warning_of(entry + "'a'\n" + sphere + entry + "'b'\ndiameter = 1\n"),
                             ": inelastic rods can"));
}

TEST(Warning, IsGivenForAContactTimeThatCannotHelp) {
  EXPECT_EQ(warned_of("until.time = 1\ncollisions = {epsilon = 0, tc = 0.1}"),
            Keys{"collisions.tc"});
  EXPECT_EQ(warned_of("until.time = 1\ncollisions = {epsilon = 0.5, tc_relative = 1e-8}"),
            Keys{"collisions.tc_relative"});
  EXPECT_EQ(warned_of("until.time = 1\ncollisions = {epsilon = 0.5, tc_relative = 0.1}"),
            Keys{"collisions.tc_relative"});
  EXPECT_EQ(warned_of("until.time = 1\ncollisions = {epsilon = 0.5, tc_relative = 0.09}"), Keys{});
  EXPECT_EQ(warned_of("until.time = 1\ncollisions.tc = 0.1"), Keys{"collisions.tc"});
}

TEST(Warning, IsGivenForAThresholdWithoutSliding) {
  EXPECT_EQ(warned_of("until.time = 1\ncollisions.sliding_below = 1e-2"),
            Keys{"collisions.sliding_below"});
  EXPECT_EQ(warned_of("until.time = 1\ncollisions = {epsilon = 0.5, sliding = true, "
                      "sliding_below = 1e-2}"),
            Keys{});
}

// What [[pairs]] change counts, and every species.
TEST(Warning, LooksAtAllSpeciesAndPairs) {
  const auto of = [](const std::string& begin, const std::string& end) {
    std::vector<std::string> keys;
    for (const std::string& w : warnings(parse_scene(
             begin +
                 "\nneedles.box = 4\n[[species]]\nname = 'a'\ncount = 5\n[[species]]\nname = "
                 "'b'\ncount = 5\n" +
                 end,
             "s.toml"))) {
      keys.push_back(w.substr(0, w.find(':')));
    }
    return keys;
  };
  const std::string pair = "[[pairs]]\nbetween = ['a', 'b']\nepsilon = 0.5\n";
  EXPECT_EQ(of("until.energy_ratio = 0.5\ncollisions.tc_relative = 1e-3", pair), Keys{});
  EXPECT_EQ(of("until.time = 1", pair), Keys{"pairs.epsilon = 0.5 of a-b"});
  EXPECT_EQ(of("until.time = 1\ncollisions.epsilon = 0.8", pair),
            (Keys{"collisions.epsilon = 0.8", "pairs.epsilon = 0.5 of a-b"}));
  EXPECT_EQ(of("until.time = 1", "k = 1\nt_tr = 0\nt_rot = 0\n"), Keys{"species.k = 1 of b"});
}

TEST(Warning, NamesTheKeyOfASingleSpecies) {
  const auto found = warnings(parse_scene(
      "until.time = 1\nneedles.box = 4\n[[species]]\nname = 'a'\ncount = 5\nk = 1", "s.toml"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].substr(0, found[0].find(':')), "species.k = 1");
}

TEST(Warning, IsGivenForWallsAndDriving) {
  const std::string wall = "\n[[walls]]\naxis = 'z'\nside = 'low'\nepsilon = ";
  const std::string falls = "until.time = 1\nforces.gravity = [0, 0, -1]\n";
  EXPECT_EQ(warned_of(falls + wall + "1"), Keys{});
  EXPECT_EQ(warned_of(falls + wall + "0.5"), Keys{"walls.epsilon"});
  EXPECT_EQ(warned_of(falls + "collisions.tc_relative = 1e-3" + wall + "0.5"), Keys{});
  EXPECT_EQ(warned_of(falls + "collisions.sliding = true" + wall + "0.5"), Keys{});
  EXPECT_EQ(warned_of(falls + "collisions.tc_relative = 1e-3" + wall + "0"), Keys{"walls.epsilon"});
  EXPECT_EQ(warned_of("until.time = 1\ncollisions.tc_relative = 1e-3" + wall +
                      "0\n[[walls]]\naxis = 'z'\nside = 'high'"),
            Keys{});
  EXPECT_EQ(warned_of("until.time = 1\ndriving.kicks.every = 1"), Keys{"driving.kicks"});
  EXPECT_EQ(warned_of("until.time = 1\ndriving.kicks = {every = 1, rotational = 1}"), Keys{});
  // They set in motion what is at rest, and change the energy.
  const std::string at_rest = "until.time = 1\ninitial = {t_tr = 0, t_rot = 0}\n";
  EXPECT_EQ(warned_of(at_rest), Keys{"initial.t_tr,"});
  EXPECT_EQ(warned_of(at_rest + "driving.andersen = {rate = 1, temperature = 1}"), Keys{});
  EXPECT_EQ(warned_of(at_rest + "forces.gravity = [0, 0, -1]" + wall + "1"), Keys{});
  EXPECT_EQ(warned_of("until.energy_ratio = 0.5\ndriving.andersen = {rate = 1, temperature = 1}"),
            Keys{});
}

TEST(Warning, IsGivenForEndsThatAreNeverOrAtOnceMet) {
  EXPECT_EQ(warned_of("until.energy_ratio = 0.5"), Keys{"until.energy_ratio"});
  EXPECT_EQ(warned_of("until.energy_ratio = 0.5\ncollisions.beta = 1"), Keys{"until.energy_ratio"});
  EXPECT_EQ(warned_of("until.energy_ratio = 0.5\ncollisions.beta = 0"), Keys{});
  EXPECT_EQ(warned_of("until.energy_ratio = 1"), Keys{"until.energy_ratio"});
}

TEST(Warning, IsGivenForStillnessAndOddMassDistributions) {
  EXPECT_EQ(warned_of("until.time = 1\ninitial = {t_tr = 0, t_rot = 0}"), Keys{"initial.t_tr,"});
  EXPECT_EQ(warned_of("until.time = 1\ninitial = {t_tr = 0}"), Keys{});
  EXPECT_EQ(warned_of("until.time = 1\nneedles.k = 1"), Keys{"needles.k"});
}

TEST(Warning, IsGivenForKnobsOfAccuracyWithoutEffect) {
  const auto warned = [](const std::string& engine) {
    return warned_of("until.time = 1\n[engine]\n" + engine);
  };
  EXPECT_EQ(warned("accuracy = 'fast'\nroot_tolerance = 1e-9\nfilter = 'double'"), Keys{});
  EXPECT_EQ(warned("isolation = 'sampling'\nsampling_step = 0.1"), Keys{});
  EXPECT_EQ(warned("accuracy = 'rigorous'\nfilter = 'float'"), Keys{});
  EXPECT_EQ(warned("sampling_step = 0.1"), Keys{"engine.sampling_step"});
  EXPECT_EQ(warned("escalation = 'always'\nroot_tolerance = 1e-9"), Keys{"engine.root_tolerance"});
  EXPECT_EQ(warned("accuracy = 'rigorous'\nroot_tolerance = 1e-9"), Keys{"engine.root_tolerance"});
  EXPECT_EQ(warned("search = 'linked-lists'\nfilter = 'double'"), Keys{"engine.filter"});
  EXPECT_EQ(warned("accuracy = 'rigorous'\nisolation = 'bounds'"), Keys{"engine.accuracy"});
  EXPECT_EQ(warned("accuracy = 'rigorous'\nescalation = 'never'"), Keys{"engine.accuracy"});
}

TEST(Warning, IsGivenForSizesThatASearchHasNot) {
  const auto warned = [](const std::string& search) {
    return warned_of("until.time = 1\n[engine]\ncell_side = 1\ncapsule_radius = 0.2\nsearch = '" +
                     search + "'");
  };
  EXPECT_EQ(warned("auto"), Keys{});
  EXPECT_EQ(warned("capsules"), Keys{});
  EXPECT_EQ(warned("linked-cells"), Keys{"engine.capsule_radius"});
  EXPECT_EQ(warned("linked-lists"), Keys{"engine.capsule_radius"});
  EXPECT_EQ(warned("all-pairs"), (Keys{"engine.cell_side", "engine.capsule_radius"}));
}

TEST(Warning, IsGivenForOutputThatIsLost) {
  EXPECT_EQ(warned_of("until.time = 1\noutput.events = true"), Keys{"output.events"});
  EXPECT_EQ(warned_of("until.time = 1\noutput.frames = 2"), Keys{"output.frames"});
  EXPECT_EQ(warned_of("until.time = 1\noutput.observables = ['fields']"),
            Keys{"output.observables"});
  EXPECT_EQ(warned_of("until.time = 1\noutput.series_every = 1"), Keys{"output.series_every"});
  EXPECT_EQ(warned_of("until.time = 1\noutput.grid = 2"), Keys{"output.grid"});
  EXPECT_EQ(warned_of("until.time = 1\noutput = {file = 'a', frames = [0, 2]}"),
            Keys{"output.frames"});
}

}  // namespace
}  // namespace needlework
