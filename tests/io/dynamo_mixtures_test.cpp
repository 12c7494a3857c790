// Several species in configurations of DynamO.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "src/io/formats/dynamo.h"
#include "tests/io/complaints.h"
#include "tests/io/exported_files.h"
#include "tests/support/wall.h"

namespace needlework::io {
namespace {

const std::string light =
    R"(<Species Name="light" Type="SphericalTop" Mass="1" InertiaConstant="0.125"><IDRange Type="Ranged" Start="3" End="5"/></Species>)";
const std::string heavy =
    R"(<Species Name="heavy" Type="Lines" Mass="4" InertiaConstant="0.0625"><IDRange Type="List"><ID val="2"/><ID val="0"/><ID val="1"/></IDRange></Species>)";
const std::string between =
    R"(<Interaction Type="Lines" Name="b" Length="1.5" Elasticity="0.5"><IDPairRange Type="Pair"><IDRange Type="List"><ID val="0"/><ID val="1"/><ID val="2"/></IDRange><IDRange Type="Ranged" Start="3" End="5"/></IDPairRange></Interaction>)";
const std::string of_heavy =
    R"(<Interaction Type="Lines" Name="h" Length="1.5" Elasticity="0.75"><IDPairRange Type="Single"><IDRange Type="Ranged" Start="0" End="2"/></IDPairRange></Interaction>)";
const std::string of_all =
    R"(<Interaction Type="Lines" Name="a" Length="1.5" Elasticity="1"><IDPairRange Type="All"/></Interaction>)";

std::string configuration(const std::string& species, const std::string& interactions,
                          const std::string& locals = "", bool of_lines = true) {
  std::string text =
      "<DynamOconfig version=\"1.5.0\"><Simulation><SimulationSize x=\"8\" y=\"8\" z=\"8\"/>\n"
      "<Genus>" +
      species + "</Genus>\n<BC Type=\"" + (locals.empty() ? "PBC" : "NoXPBC") +
      "\"/>\n<Interactions>" + interactions + "</Interactions>\n<Locals>" + locals +
      "</Locals><Dynamics Type=\"Newtonian\"/></Simulation><ParticleData" +
      (of_lines ? " OrientationData=\"Y\">\n" : ">\n");
  for (int i = 0; i < 6; ++i) {
    text += fmt::format("<Pt ID=\"{}\"><P x=\"{}\" y=\"0\" z=\"0\"/><V x=\"0\" y=\"0\" z=\"0\"/>",
                        i, i - 3);
    if (of_lines) text += R"(<O x="0" y="0" z="0"/><U x="0" y="0" z="0" w="1"/>)";
    text += "</Pt>\n";
  }
  return text + "</ParticleData></DynamOconfig>\n";
}

const std::string lines = configuration(light + heavy, between + of_heavy + of_all);

// Three spheres of diameter 0.1, and three of 0.2, of which 0.15 is the mean but for a rounding.
std::string point(const char* name, const char* mass, int first, int last) {
  return fmt::format(
      R"(<Species Name="{}" Type="Point" Mass="{}"><IDRange Type="Ranged" Start="{}" End="{}"/></Species>)",
      name, mass, first, last);
}
std::string hard_spheres(const char* name, const char* diameter, const std::string& pairs) {
  return fmt::format(
      R"(<Interaction Type="HardSphere" Name="{}" Diameter="{}" Elasticity="0.5">{}</Interaction>)",
      name, diameter, pairs);
}
const std::string first_range = R"(<IDRange Type="Ranged" Start="0" End="2"/>)";
const std::string second_range = R"(<IDRange Type="Ranged" Start="3" End="5"/>)";
std::string wall_of(const std::string& range, const char* diameter, const char* place = "-4",
                    const char* epsilon = "1", const char* normal = "1") {
  return fmt::format(
      R"(<Local Type="Wall" Name="w" Elasticity="{}" Diameter="{}">{}<Norm x="{}" y="0" z="0"/><Origin x="{}" y="0" z="0"/></Local>)",
      epsilon, diameter, range, normal, place);
}
std::string spheres_with(const std::string& locals) {
  return configuration(
      point("small", "1", 0, 2) + point("large", "8", 3, 5),
      hard_spheres("s", "0.1", "<IDPairRange Type=\"Single\">" + first_range + "</IDPairRange>") +
          hard_spheres("l", "0.2",
                       "<IDPairRange Type=\"Single\">" + second_range + "</IDPairRange>") +
          hard_spheres(
              "m", "0.15",
              "<IDPairRange Type=\"Pair\">" + second_range + first_range + "</IDPairRange>"),
      locals, false);
}

class DynamoMixtures : public Formats {
 protected:
  Configuration read(const std::string& text) const {
    std::ofstream(file("a.xml"), std::ios::binary) << text;
    return read_dynamo(file("a.xml"));
  }
  // All of what is said of a text with one fault.
  void expect_message(const std::string& good, const std::string& from, const std::string& to,
                      const std::string& message) const {
    EXPECT_EQ(complaint(replaced(good, from, to)), message);
  }
};

TEST_F(DynamoMixtures, AreReadFromRangesInAnyOrder) {
  const auto expect_right = [](const Configuration& read) {
    EXPECT_EQ(read.material.names, (std::vector<std::string>{"light", "heavy"}));
    EXPECT_EQ(read.material.length, (std::vector{1.5, 1.5}));
    EXPECT_EQ(read.material.mass, (std::vector{1.0, 4.0}));
    EXPECT_EQ(read.material.k, (std::vector{9.0, 18.0}));
    EXPECT_EQ(read.material.epsilon, (std::vector{1.0, 0.5, 0.5, 0.75}));
    EXPECT_EQ(read.state.species, (std::vector<SpeciesIndex>{1, 1, 1, 0, 0, 0}));
    EXPECT_EQ(read.notes,
              std::vector<std::string>{
                  "species differ in mass or moment of inertia: DynamO takes both numbers of the "
                  "first of two lines for the other one, too; here each has its own"});
  };
  expect_right(read(lines));
  // The same particles in other words.
  expect_right(read(replaced(lines, R"(<IDRange Type="Ranged" Start="3" End="5"/>)",
                             R"(<IDRange Type="Union"><IDRange Type="List"><ID val="5"/></IDRange>)"
                             R"(<IDRange Type="Ranged" Start="3" End="4"/></IDRange>)")));
  // What follows an interaction that holds a pair is not that of it.
  expect_right(read(configuration(
      light + heavy, between + of_heavy + of_all + replaced(of_heavy, "0.75", "0.25"))));
  const Configuration other = read(configuration(light + heavy, between + of_all + of_heavy));
  EXPECT_EQ(other.material.epsilon, (std::vector{1.0, 0.5, 0.5, 1.0}));
  const Configuration same = read(configuration(
      light + replaced(replaced(heavy, "\"4\"", "\"1\""), "0.0625", "0.125"), of_all));
  EXPECT_TRUE(same.notes.empty());
}

TEST_F(DynamoMixtures, OfSpheresHaveAdditiveDiameters) {
  const Configuration read = this->read(spheres_with(""));
  EXPECT_EQ(read.material.diameter, (std::vector{0.1, 0.2}));
  EXPECT_EQ(read.material.length, (std::vector{0.0, 0.0}));
  EXPECT_EQ(read.material.mass, (std::vector{1.0, 8.0}));
  EXPECT_EQ(read.material.epsilon, (std::vector{0.5, 0.5, 0.5, 0.5}));
  EXPECT_EQ(read.state.species, (std::vector<SpeciesIndex>{0, 0, 0, 1, 1, 1}));
  EXPECT_TRUE(read.notes.empty());
  expect_message(spheres_with(""), "\"0.15\"", "\"0.1500001\"",
                 "line 4: Interaction Diameter = 0.1500001: expected 0.15000000000000002, the mean "
                 "of 0.1 and 0.2, the diameters of small and large");
}

// A wall has one diameter, so there is one for each species.
TEST_F(DynamoMixtures, OfSpheresTouchWallsWithTheirSurfaces) {
  const std::string two = wall_of(second_range, "0.2") + wall_of(first_range, "0.1");
  const Configuration read = this->read(spheres_with(two));
  ASSERT_EQ(read.material.walls.size(), 1u);
  EXPECT_EQ(read.material.walls[0].axis + read.material.walls[0].side, "xlow");
  EXPECT_EQ(read.state.position[0][0], 1);
  expect_message(spheres_with(two), "Diameter=\"0.2\">" + second_range,
                 "Diameter=\"0.1\">" + second_range,
                 "line 5: Local: Diameter 0.1: expected 0.2, that of the spheres of large");
  expect_message(spheres_with(two), two, wall_of(second_range, "0.2"),
                 "line 5: Locals: the wall x-low is none for small: expected it for all species");
  expect_message(spheres_with(two), two, two + wall_of(first_range, "0.1"),
                 "line 5: Local: a second wall with this normal: expected one at each end of an "
                 "axis");
  for (const std::string& other :
       {wall_of(first_range, "0.1", "-3"), wall_of(first_range, "0.1", "-4", "0.5")}) {
    expect_message(spheres_with(two), wall_of(first_range, "0.1"), other,
                   "line 5: Local: another place, elasticity or temperature than with this normal "
                   "before: expected those of one wall for all species");
  }
}

TEST_F(DynamoMixtures, ParticlesAreOfOneSpeciesEach) {
  const std::string three = R"("Ranged" Start="3" End="5")";
  expect_message(lines, three, R"("Ranged" Start="4" End="5")",
                 "line 2: Genus: particle 3 is of no species: expected one species for each");
  expect_message(lines, three, R"("Ranged" Start="2" End="5")",
                 "line 2: Species: particle 2 is of light, too: expected one species for each");
  expect_message(lines, three, R"("Ranged" Start="3" End="6")",
                 "line 2: IDRange End = 6: expected the number of one of 6 particles, from 0");
  expect_message(lines, three, R"("Ranged" Start="-1" End="5")",
                 "line 2: IDRange Start = -1: expected the number of one of 6 particles, from 0");
  expect_message(lines, three, R"("Ranged" Start="3" End="2")",
                 "line 2: IDRange End = 2: expected a number >= 3, which is Start");
  expect_message(lines, R"(<ID val="2"/>)", R"(<ID val="1.5"/>)",
                 "line 2: ID val = 1.5: expected the number of one of 6 particles, from 0");
  expect_message(lines, R"(<ID val="2"/>)", R"(<ID val="1"/>)",
                 "line 2: IDRange: particle 1 twice: expected it once");
  expect_message(lines, three, R"("None")",
                 "line 2: IDRange Type = None: expected All, Ranged, List or Union: other ranges "
                 "cannot be carried over");
  expect_message(lines, "<IDRange Type=" + three + "/>",
                 R"(<IDRange Type="Union"><IDRange Type="Union"/></IDRange>)",
                 "line 2: IDRange Type = Union: expected All, Ranged or List inside of a union");
  expect_message(
      lines, "</Genus>",
      R"(<Species Name="none" Type="Lines" Mass="1" InertiaConstant="1"><IDRange Type="List"/></Species></Genus>)",
      "line 2: Species: no particle is of this species: expected some");
  expect_message(lines, "Name=\"heavy\"", "Name=\"light\"",
                 "line 2: Species Name = light: expected one that no other species has");
  expect_message(lines, "<IDRange Type=" + three + "/>", "",
                 "line 2: Species: IDRange is missing: expected one");
  expect_message(lines, "InertiaConstant=\"0.125\"", "InertiaConstant=\"0.125\" Range=\"All\"",
                 "line 2: Species Range = All: expected this or the element, not both");
  std::string many;
  for (int i = 0; i < 256; ++i) {
    many += replaced(replaced(light, "light", fmt::format("s{}", i)), three,
                     fmt::format(R"("Ranged" Start="{0}" End="{0}")", i));
  }
  std::string text = replaced(lines, light + heavy, many);
  std::string particles;
  for (int i = 6; i < 256; ++i) particles += "<Pt/>";
  expect_message(text, "</ParticleData>", particles + "</ParticleData>",
                 "line 2: Species: one species more than 255: expected at most as many");
}

TEST_F(DynamoMixtures, EachTwoSpeciesHaveOneInteraction) {
  expect_message(lines, of_all, "",
                 "line 4: Interactions: none of light and light: expected one for each two "
                 "species");
  expect_message(lines, of_heavy, replaced(of_heavy, "\"2\"", "\"1\""),
                 "line 4: IDRange: a range with 2 of 3 particles of heavy: expected all or none of "
                 "a species");
  expect_message(
      lines, "Length=\"1.5\" Elasticity=\"0.5\"", "Length=\"1.25\" Elasticity=\"0.5\"",
      "line 4: Interaction Length = 1.25: expected 1.5 for light and heavy, as for light "
      "and light: lines that meet have one length");
  expect_message(lines, "\"Single\"", "\"Self\"",
                 "line 4: IDPairRange Type = Self: expected All, Single or Pair: other ranges "
                 "cannot be carried over");
  expect_message(lines, "\"Single\"", "\"Pair\"",
                 "line 4: IDPairRange: 1 elements IDRange: expected 2");
  expect_message(lines, "\"Pair\"", "\"Single\"",
                 "line 4: IDPairRange: 2 elements IDRange: expected 1");
  expect_message(lines, heavy, replaced(heavy, "\"Lines\"", "\"Point\""),
                 "line 2: Species Type = Point: expected SphericalTop or Lines, as of the species "
                 "before: lines and points never meet");
  expect_message(lines, light, replaced(light, "\"SphericalTop\"", "\"Point\""),
                 "line 2: Species Type = Lines: expected Point, as of the species before: lines "
                 "and points never meet");
}

// Of up to five species, whose needles follow each other or are mixed.
State random_species(std::size_t species, bool in_order, std::mt19937_64& random) {
  State state = make_state(40, static_cast<unsigned>(random()));
  state.id.clear();
  state.image.clear();
  if (species == 1) return state;
  for (std::size_t i = 0; i < 40; ++i) {
    const std::size_t any = random() % species;
    state.species.push_back(static_cast<SpeciesIndex>(i < species ? i : any));
  }
  if (in_order) std::ranges::sort(state.species);
  if (!in_order) std::ranges::shuffle(state.species, random);
  return state;
}

void expect_same_composition(const Composition& found, const Composition& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t a = 0; a < found.size(); ++a) {
    EXPECT_EQ(found[a].name, expected[a].name);
    EXPECT_EQ(found[a].length, expected[a].length);
    EXPECT_EQ(found[a].mass, expected[a].mass);
    EXPECT_EQ(found[a].diameter, expected[a].diameter);
    EXPECT_TRUE(found[a].k == expected[a].k || !found[a].turns()) << found[a].k;
    for (std::size_t b = 0; b < found.size(); ++b) {
      EXPECT_EQ(found.restitution(a, b), expected.restitution(a, b)) << a << " and " << b;
    }
  }
}

TEST_F(DynamoMixtures, AreWrittenAndReadBitForBit) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform(0.5, 2);
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const bool of_spheres = round % 2 == 1;
    const std::size_t count = 1 + random() % 5;
    Material written;
    for (std::size_t i = 0; i < count; ++i) {
      written.names.push_back(fmt::format("<{}> & \"\u00e9 {}\"", random() % 10, i));
      written.mass.push_back(uniform(random));
      written.k.push_back(uniform(random) * std::pow(10, round % 9 - 4));
      const double length = i == 0 ? uniform(random) : written.length[0];
      written.length.push_back(of_spheres ? 0 : length);
      if (of_spheres) written.diameter.push_back(round % 4 == 1 ? 1.3 : uniform(random));
    }
    for (std::size_t n = 0; n < count * count; ++n) {
      const std::size_t a = n / count, b = n % count;
      const bool equal = round % 3 == 0;
      written.epsilon.push_back(b < a   ? written.epsilon[b * count + a]
                                : equal ? 0.9
                                        : uniform(random) / 2);
    }
    written.beta.assign(count * count, -1);
    State state = random_species(count, round % 5 < 2, random);
    if (of_spheres) {
      for (auto& u : state.orientation) u = {0, 0, 1};
      for (auto& w : state.angular_velocity) w = {};
    } else {
      state.orientation[0] = {0, 0, -1};
      state.orientation[1] = {-0.0, 0x1.fffffffffffffp-1, 1e-9};
      state.orientation[2] = {0, 0, 1 - 0x1p-53};
      for (const int i : {0, 1, 2}) state.angular_velocity[i] = {3, 0, -0.0};
    }
    const bool walled = round % 4 > 1;
    if (walled) {
      written.walls = {test::wall("z", "both", 0.5)};
      state.periodic[2] = false;
      for (auto& centre : state.position) centre[2] = 0.5 * state.box[2];  // moved without rounding
    }
    const Configuration read = read_dynamo(put(round % 7   ? "a.xml"
                                               : round % 2 ? "a.xml.gz"
                                                           : "a.xml.bz2",
                                               {state}, written));
    expect_same(read.state, state);
    EXPECT_EQ(read.state.species, state.species);
    EXPECT_EQ(read.state.periodic, state.periodic);
    expect_same_composition(composition_of(read.material, "read"),
                            composition_of(written, "written"));
    ASSERT_EQ(read.material.walls.size(), walled ? 2u : 0u);
    for (const Scene::Wall& wall : read.material.walls) EXPECT_EQ(wall.epsilon, 0.5);
  }
}

TEST_F(DynamoMixtures, ThatCannotBeWrittenSayWhy) {
  const auto message = [&](const Material& of, const std::vector<SpeciesIndex>& species) {
    State state = make_state(2);
    state.species = species;
    const std::string found = message_of<InputError>([&] { put("b.xml", {state}, of); });
    EXPECT_FALSE(std::ifstream(file("b.xml")).is_open());
    return found;
  };
  Material two{.names = {"a", "b"},
               .length = {1, 1.25},
               .mass = {1, 1},
               .k = {6, 6},
               .epsilon = {1, 1, 1, 1},
               .beta = {-1, -1, -1, -1}};
  EXPECT_EQ(message(two, {0, 1}),
            file("b.xml") +
                ": needles of length 1 and 1.25: expected one length, as lines of DynamO that meet "
                "have one length");
  two.length = {1, 1};
  EXPECT_EQ(message(two, {1, 1}),
            file("b.xml") +
                ": no needle of the species a: expected some, as ranges of DynamO know a species "
                "by its particles");
  two.length = {1, 0};
  two.diameter = {0, 1};
  EXPECT_EQ(message(two, {0, 1}),
            file("b.xml") +
                ": needles beside spheres: expected one of both, as lines and points of DynamO "
                "never meet");
}

}  // namespace
}  // namespace needlework::io
