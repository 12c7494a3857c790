// Scenes with [[species]].
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "tests/scene/message.h"

namespace needlework {
namespace {

using test::message;
using test::Overrides;

// Lines 1 to 6, so that more begins at line 7.
const std::string least_species = R"(needles.box = 12
until.time = 5
[[species]]
name = "rods"
count = 10

)";
const std::string not_both =
    "expected either [[species]] or needles.count, needles.k, needles.diameter and the "
    "temperatures of [initial], "
    "not both";

TEST(Species, HasDefaults) {
  const Scene scene = parse_scene(least_species, "s.toml");
  ASSERT_EQ(scene.species.size(), 1u);
  const Scene::Species& species = scene.species.front();
  EXPECT_EQ(species.name, "rods");
  EXPECT_EQ(species.count, 10u);
  EXPECT_EQ(species.length, 1);
  EXPECT_EQ(species.mass, 1);
  EXPECT_EQ(species.k, 6);
  EXPECT_EQ(species.t_tr, 1);
  EXPECT_EQ(species.t_rot, 1);
}

// Of the keys of [needles] they replace, only the count is that of all needles in any scene.
TEST(Species, ReplaceNeedlesAndInitial) {
  const Scene scene = parse_scene(
      least_species + "length = 2.5\nmass = 0.5\nk = 2\nt_tr = 3\nt_rot = 0\n[initial]\n",
      "s.toml");
  const Scene::Species& species = scene.species.at(0);
  EXPECT_EQ(species.length, 2.5);
  EXPECT_EQ(species.mass, 0.5);
  EXPECT_EQ(scene.needles.count, 10u);
  EXPECT_EQ(scene.needles.k, Scene().needles.k);
  const Composition composition = scene.composition();
  EXPECT_EQ(composition.count(), 10u);
  EXPECT_EQ(composition[0].k, 2);
  EXPECT_EQ(composition[0].t_tr, 3);
  EXPECT_EQ(composition[0].t_rot, 0);
  EXPECT_EQ(scene.needles.box, (std::array{12.0, 12.0, 12.0}));
  EXPECT_EQ(scene.places.at("species.count"), "s.toml: line 5: species.count = 10");
  EXPECT_EQ(scene.places.at("needles.count"), "s.toml: line 5: species.count = 10");
}

TEST(Species, MayBeWrittenInline) {
  const Scene scene = parse_scene(
      "species = [{name = 'rods', count = 3, k = 2}]\nneedles.box = 4\nuntil.time = 1\n", "s.toml");
  ASSERT_EQ(scene.species.size(), 1u);
  EXPECT_EQ(scene.species[0].count, 3u);
  EXPECT_EQ(scene.composition()[0].k, 2);
}

TEST(Species, MayStartFromAFile) {
  const Scene scene = parse_scene(
      "initial.file = 'a.h5'\nuntil.time = 1\n[[species]]\nname = 'rods'\nlength = 2\n", "s.toml");
  EXPECT_EQ(scene.initial.file, "a.h5");
  EXPECT_EQ(scene.species.at(0).length, 2);
  EXPECT_EQ(scene.needles.count, 0u);
}

TEST(Species, CanBeOverridden) {
  const Scene scene =
      parse_scene(least_species, "s.toml", Overrides{"species.count=7", "species.mass=4"});
  EXPECT_EQ(scene.species.at(0).count, 7u);
  EXPECT_EQ(scene.needles.count, 7u);
  EXPECT_EQ(scene.species.at(0).mass, 4);
  EXPECT_EQ(scene.places.at("needles.count"), "--set species.count=7");
  // A file in place of temperatures, as for [initial].
  const Scene restart =
      parse_scene(least_species + "t_tr = 2\nt_rot = 3", "s.toml", Overrides{"initial.file=a.h5"});
  EXPECT_EQ(restart.initial.file, "a.h5");
  EXPECT_EQ(restart.species.at(0).t_tr, 1);
}

TEST(BadSpecies, IsNamedWithItsLine) {
  const std::string count = "expected a whole number in digits, from 0 to 4294967294";
  const std::string length = "expected a number > 0 (from 1e-6 to 1e6), or 0 for spheres";
  const std::string k = "expected a number > 0 (from 1e-9 to 1e9; 6 is a uniform rod)";
  const std::string temperature = "expected a temperature >= 0 (0, or from 1e-200 to 1e200)";
  const std::string name = "expected a name without control characters, not empty";
  const std::string keys =
      "expected one of name, count, length, diameter, mass, k, inertia, t_tr, t_rot, fixed, "
      "overlap";
  const std::string either = "expected either file or temperatures to draw, not both";
  // The keys of [needles] in one section.
  const auto least_of = [](const std::string& key) {
    return "until.time = 5\n[[species]]\nname = 'rods'\ncount = 10\n[needles]\nbox = 12\n" +
           key.substr(key.find('.') + 1);
  };
  const std::string head = "needles.box = 12\nuntil.time = 5\n[[species]]\n";
  const std::vector<std::pair<std::string, std::string>> table = {
      {least_species + "[[species]]\nname = 'long'",
       "s.toml: species.count of the entry 2 is missing: " + count},
      {head + "name = 'long'\n[[species]]\nname = 'rods'\ncount = 5",
       "s.toml: species.count is missing: " + count},
      {head + "count = 5\n[[species]]\nname = 'rods'\ncount = 5",
       "s.toml: species.name is missing: " + name},
      {least_species + "[[pairs]]\nepsilon = 1\n[[pairs]]\nbetween = ['rods', 'rods']",
       "s.toml: pairs.between is missing: expected an array of the names of two species"},
      {least_species + "[[species]]\nname = 'long'\ncount = 5\nlength = 7",
       "s.toml: line 1: needles.box = 12: expected edges of at least 14.07 (2.01 needle "
       "lengths), of the longest species"},
      {least_species + "[[pairs]]\nepsilon = 1",
       "s.toml: pairs.between is missing: expected an array of the names of two species"},
      {least_species + "[[pairs]]\nbetween = ['rods']",
       "s.toml: line 8: pairs.between = ['rods']: expected an array of the names of two species"},
      {least_species + "[[pairs]]\nbetween = ['rods', 'rods']\nepsilon = 2",
       "s.toml: line 9: pairs.epsilon = 2: expected a number from 0 to 1"},
      {least_species + "[pairs]\nepsilon = 1",
       "s.toml: line 7: [pairs]: expected [[pairs]], in double brackets"},
      {"needles.box = 12\nuntil.time = 5\n[species]\nname = 'rods'\ncount = 5",
       "s.toml: line 3: [species]: expected [[species]], in double brackets"},
      {"species.count = 5", "s.toml: line 1: [species]: expected [[species]], in double brackets"},
      {"[[specis]]\ncount = 5",
       "s.toml: line 1: [[specis]]: expected one of the sections needles, species, initial, "
       "collisions, pairs, walls, forces, shear, driving, engine, until, output, did you mean "
       "species?"},
      {least_of("needles.count = 5"), "s.toml: line 7: needles.count = 5: " + not_both},
      {least_of("needles.k = 6"), "s.toml: line 7: needles.k = 6: " + not_both},
      {least_species + "[initial]\nt_tr = 1", "s.toml: line 8: initial.t_tr = 1: " + not_both},
      {least_species + "[initial]\nt_rot = 1", "s.toml: line 8: initial.t_rot = 1: " + not_both},
      {"[needles]\ncount = 5\nbox = 12\n[[species]]\nname = 'rods'\n",
       "s.toml: line 5: species.name = 'rods': " + not_both},
      {head + "name = 'rods'", "s.toml: species.count is missing: " + count},
      {head + "count = 4", "s.toml: species.name is missing: " + name},
      {"until.time = 5\n[[species]]\nname = 'rods'\ncount = 4\n",
       "s.toml: needles.box is missing: expected an edge from 2.01 to 1e9, or an array of three "
       "edges"},
      {head + "name = ''", "s.toml: line 4: species.name = '': " + name},
      {head + "name = 5", "s.toml: line 4: species.name = 5: " + name},
      {head + "count = -1", "s.toml: line 4: species.count = -1: " + count},
      {least_species + "length = 2e6", "s.toml: line 7: species.length = 2e6: " + length},
      {least_species + "k = 0", "s.toml: line 7: species.k = 0: " + k},
      {least_species + "t_tr = -1", "s.toml: line 7: species.t_tr = -1: " + temperature},
      {least_species + "lenght = 2",
       "s.toml: line 7: species.lenght = 2: " + keys + ", did you mean length?"},
      {least_species + "xyzzy = 2", "s.toml: line 7: species.xyzzy = 2: " + keys},
      {least_species + "t_tr = 1\n[initial]\nfile = 'a.h5'",
       "s.toml: line 9: initial.file = 'a.h5': " + either},
      {"initial.file = 'a.h5'\nuntil.time = 1\n[[species]]\nname = 'rods'\nt_rot = 1",
       "s.toml: line 5: species.t_rot = 1: " + either},
  };
  for (const auto& [text, expected] : table) EXPECT_EQ(message(text), expected) << text;
}

TEST(BadSpecies, NeedsABoxOfTwiceItsLength) {
  const std::string line = "s.toml: line 1: needles.box = ";
  EXPECT_EQ(message(least_species + "length = 6"),
            line + "12: expected edges of at least 12.06 (2.01 needle lengths)");
  EXPECT_EQ(message(least_species + "length = 5.9"), "no error");
  const auto in_box = [](const std::string& box, const std::string& length) {
    return message("needles.box = " + box + "\nuntil.time = 5\n[[species]]\nname = 'rods'\n" +
                   "count = 10\nlength = " + length);
  };
  EXPECT_EQ(in_box("[12, 8, 12]", "4"),
            line + "[12, 8, 12]: expected edges of at least 8.04 (2.01 needle lengths)");
  // Short needles need less than those of length 1.
  EXPECT_EQ(in_box("0.5", "0.2"), "no error");
  EXPECT_EQ(in_box("0.5", "0.25"),
            line + "0.5: expected edges of at least 0.5025 (2.01 needle lengths)");
  EXPECT_EQ(message(least_species, {"species.length=100"}),
            line + "12: expected edges of at least 201 (2.01 needle lengths)");
  EXPECT_EQ(message(least_species + "length = 5", {"needles.box=10"}),
            "--set needles.box=10: expected edges of at least 10.05 (2.01 needle lengths)");
}

const std::string mixture = least_species +
                            "[[species]]\nname = 'long rods'\ncount = 4\nlength = 3\nmass = 5\n"
                            "t_tr = 0.5\n[[pairs]]\nbetween = ['long rods', 'rods']\nbeta = 0.5\n"
                            "[[pairs]]\nbetween = ['rods', 'rods']\nepsilon = 0.7\n";

TEST(Mixture, IsReadInTheOrderOfTheScene) {
  const Scene scene = parse_scene(mixture + "[collisions]\nepsilon = 0.9\n", "s.toml");
  EXPECT_EQ(scene.needles.count, 14u);
  const Composition composition = scene.composition();
  ASSERT_EQ(composition.size(), 2u);
  EXPECT_EQ(composition[0].name, "rods");
  EXPECT_EQ(composition[1].length, 3);
  EXPECT_EQ(composition.longest(), 3);
  EXPECT_EQ(composition.restitution(0, 0), (Restitution{0.7, -1}));
  EXPECT_EQ(composition.restitution(1, 0), (Restitution{0.9, 0.5}));
  EXPECT_EQ(composition.restitution(0, 1), (Restitution{0.9, 0.5}));
  EXPECT_EQ(composition.restitution(1, 1), (Restitution{0.9, -1}));
  EXPECT_EQ(composition[0].t_tr, 1);
  EXPECT_EQ(composition[1].t_tr, 0.5);
}

TEST(Mixture, IsOverriddenByName) {
  const Scene scene = parse_scene(
      mixture, "s.toml",
      Overrides{"species.rods.count=20", "species.long rods.mass=7", "species.\"long rods\".k=2",
                "pairs.rods-rods.epsilon=0.5", "pairs.long rods-rods.epsilon=0.6"});
  EXPECT_EQ(scene.species[0].count, 20u);
  EXPECT_EQ(scene.species[0].k, 6);
  EXPECT_EQ(scene.species[1].mass, 7);
  EXPECT_EQ(scene.species[1].k, 2);
  EXPECT_EQ(scene.pairs[1].epsilon, 0.5);
  EXPECT_EQ(scene.pairs[0].epsilon, 0.6);
  EXPECT_EQ(scene.pairs[0].beta, 0.5);
  const std::string names = " with one of the names rods, long rods";
  EXPECT_EQ(message(mixture, {"species.count=3"}),
            "--set species.count=3: expected species.NAME.count" + names);
  EXPECT_EQ(message(mixture, {"species.x.count=3"}),
            "--set species.x.count=3: expected species.NAME.count" + names);
  EXPECT_EQ(message(mixture, {"species.rods.count=-3"}),
            "--set species.rods.count=-3: expected a whole number in digits, from 0 to 4294967294");
  EXPECT_EQ(message(mixture, {"needles.rods.box=3"}),
            "--set needles.rods.box=3: expected section.key=value");
}

TEST(BadSpecies, CannotBeMadeByOverrides) {
  const std::string plain = "needles.count = 3\nneedles.box = 12\nuntil.time = 5\n";
  EXPECT_EQ(message(plain, {"species.length=2"}),
            "--set species.length=2: expected a scene with an entry [[species]]");
  EXPECT_EQ(message(least_species, {"species.length=2"}), "no error");
  EXPECT_EQ(message(least_species, {"species.length=-2"}),
            "--set species.length=-2: expected a number > 0 (from 1e-6 to 1e6), or 0 for spheres");
  EXPECT_EQ(message(least_species, {"needles.count=5"}), "--set needles.count=5: " + not_both);
  EXPECT_EQ(message(least_species, {"initial.t_tr=5"}), "--set initial.t_tr=5: " + not_both);
  EXPECT_EQ(message(least_species, {"species.lenght=5"}),
            "--set species.lenght=5: expected one of name, count, length, diameter, mass, k, "
            "inertia, t_tr, t_rot, fixed, overlap, "
            "did you mean length?");
}

}  // namespace
}  // namespace needlework
