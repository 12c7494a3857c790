// Rods of finite width and spheres in the formats of other programs.
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "src/io/formats/columns.h"
#include "src/io/formats/dynamo.h"
#include "src/io/vtkhdf.h"
#include "tests/io/complaints.h"
#include "tests/io/exported_files.h"
#include "tests/support/contains.h"
#include "tests/support/wall.h"

namespace needlework::io {
namespace {

class RodFormats : public Formats {
 protected:
  // The last COUNT numbers of the first line of needles behind a line that contains HEAD.
  std::vector<double> ending(const std::string& name, const std::string& head,
                             std::size_t count) const {
    std::istringstream text(text_of_file(name));
    std::string line;
    while (std::getline(text, line) && line.find(head) == line.npos) continue;
    std::getline(text, line);
    std::istringstream words(line);
    std::vector<double> numbers;
    for (std::string word; words >> word;) {
      if (word != "X") numbers.push_back(std::stod(word));
    }
    EXPECT_GE(numbers.size(), count) << line;
    return {numbers.end() - static_cast<std::ptrdiff_t>(std::min(count, numbers.size())),
            numbers.end()};
  }
};

const Material rods_and_spheres{.names = {"rod", "ball"},
                                .length = {1.7, 0},
                                .mass = {2.5, 1},
                                .k = {3.3, 6},
                                .diameter = {0.4, 1.1},
                                .epsilon = {0.9, 0.8, 0.8, 0.7},
                                .beta = {-1, -1, -1, -1}};
const Material spheres{.names = {"ball"},
                       .length = {0},
                       .mass = {2.5},
                       .k = {6},
                       .diameter = {1.3},
                       .epsilon = {0.9},
                       .beta = {-1}};

State spinless(std::size_t count) {
  State state = make_state(count, 7);
  for (auto& u : state.orientation) u = {0, 0, 1};
  for (auto& w : state.angular_velocity) w = {};
  return state;
}

TEST_F(RodFormats, HoldLengthAndDiameter) {
  State state = make_state(20);
  for (std::size_t i = 0; i < state.size(); ++i)
    state.species.push_back(static_cast<SpeciesIndex>(i % 2));
  for (const char* name : {"a.xyz", "a.dump"}) {
    const Configuration read = read_configuration(put(name, {state}, rods_and_spheres));
    EXPECT_EQ(read.state.species, state.species) << name;
    EXPECT_EQ(read.material.length, rods_and_spheres.length) << name;
    EXPECT_EQ(read.material.diameter, rods_and_spheres.diameter) << name;
    EXPECT_EQ(read.material.k, rods_and_spheres.k) << name;
    EXPECT_EQ(read.material.mass, rods_and_spheres.mass) << name;
    const Composition composition = composition_of(read.material, name);
    EXPECT_TRUE(composition.has_width());
    EXPECT_EQ(composition[1].diameter, 1.1);
  }
  EXPECT_EQ(text_of(read_configuration(file("a.xyz")).material), text_of(rods_and_spheres));
  for (const char* name : {"b.xyz", "b.dump"}) {
    const Configuration read = read_configuration(put(name, {spinless(5)}, spheres));
    EXPECT_EQ(read.material.length, std::vector{0.0}) << name;
    EXPECT_EQ(read.material.diameter, std::vector{1.3}) << name;
    EXPECT_TRUE(are_spheres(read.material));
  }
}

// OVITO draws spherocylinders by radius and length, and spheres alone by three radii.
TEST_F(RodFormats, SayHowToDrawThem) {
  State one = make_state(1);
  one.species = {0};
  put("a.xyz", {one}, rods_and_spheres);
  EXPECT_EQ(ending("a.xyz", "Lattice", 4), (std::vector{0.2, 0.2, 1.7, 0.0}));
  put("a.dump", {one}, rods_and_spheres);
  EXPECT_TRUE(
      test::contains(text_of_file("a.dump"), "shapex shapey shapez length diameter mass k\n"));
  EXPECT_EQ(ending("a.dump", "ITEM: ATOMS", 7), (std::vector{0.4, 0.4, 3.4, 1.7, 0.4, 2.5, 3.3}));
  one.species = {1};
  put("b.dump", {one}, rods_and_spheres);
  EXPECT_EQ(ending("b.dump", "ITEM: ATOMS", 7), (std::vector{1.1, 1.1, 0.0, 0.0, 1.1, 1.0, 6.0}));
  put("b.xyz", {spinless(1)}, spheres);
  EXPECT_EQ(ending("b.xyz", "Lattice", 3), (std::vector{0.65, 0.65, 0.65}));
}

TEST_F(RodFormats, DumpsWithoutAColumnOfLengthsHaveNeedles) {
  const auto read = [&](const std::string& columns, const std::string& values) {
    std::ofstream(file("a.dump")) << lammps_dump(
        2, columns + " x y z vx vy vz mux muy muz omegax omegay omegaz",
        values + " 1 2 3 4 5 6 1 0 0 0 7 8\n" + values + " 4 2 3 4 5 6 1 0 0 0 7 8\n");
    return read_configuration(file("a.dump")).material;
  };
  EXPECT_EQ(read("diameter", "1.5").length, std::vector{1.5});
  EXPECT_FALSE(has_width(read("diameter", "1.5")));
  EXPECT_EQ(read("length diameter", "0 1.5").length, std::vector{0.0});
  EXPECT_EQ(read("diameter length", "1.5 2").diameter, std::vector{1.5});
  EXPECT_EQ(message_of<InputError>([&] { read("length", "0"); }),
            file("a.dump") + ": line 10: length = 0: expected a number > 0");
  EXPECT_EQ(message_of<InputError>([&] { read("length diameter", "-1 1"); }),
            file("a.dump") + ": line 10: length = -1: expected a number > 0, or 0 for a sphere");
  EXPECT_EQ(
      message_of<InputError>([&] { read("length diameter", "1 -1"); }),
      file("a.dump") + ": line 10: diameter = -1: expected a number > 0, or 0 for a thin needle");
  EXPECT_EQ(read("length diameter", "1 0").diameter, std::vector{0.0});
}

TEST_F(RodFormats, WithoutAKAreHomogeneous) {
  Material material = rods_and_spheres;
  material.k.clear();
  const Composition composition = composition_of(material, "a");
  EXPECT_EQ(composition[0].k, homogeneous_k(1.7, 0.4));
  material.diameter = {1, 2, 3};
  EXPECT_EQ(message_of<InputError>([&] { composition_of(material, "a"); }),
            "a: 2 numbers of length: expected 3, one for each species");
}

TEST_F(RodFormats, OfLinesHaveTheRadiusOfTubes) {
  State state = make_state(3);
  state.species = {1, 0, 1};
  put("a.vtkhdf", {state}, rods_and_spheres);
  EXPECT_EQ(read_numbers(file("a.vtkhdf"), "/VTKHDF/PointData/radius"),
            (std::vector{0.55, 0.55, 0.2, 0.2, 0.55, 0.55}));
  const std::vector<double> points = read_numbers(file("a.vtkhdf"), "/VTKHDF/Points");
  const double* rod = &points[6];
  EXPECT_NEAR(std::hypot(rod[3] - rod[0], rod[4] - rod[1], rod[5] - rod[2]), 1.7, 1e-14);
  EXPECT_EQ(points[12], points[15]);  // of a sphere, the line is a point
  put("a.pvd", {state}, rods_and_spheres);
  EXPECT_TRUE(test::contains(text_of_file("a/frame-00000.vtu"),
                             "Name=\"radius\" NumberOfComponents=\"1\""));
  state.species.clear();
  put("b.pvd", {state});
  EXPECT_FALSE(test::contains(text_of_file("b/frame-00000.vtu"), "radius"));
}

TEST_F(RodFormats, ThatCannotHoldThemSayWhy) {
  const auto message = [&](const char* name, const Material& of) {
    return message_of<InputError>([&] { put(name, {make_state(2)}, of); });
  };
  EXPECT_EQ(message("a.data", spheres),
            file("a.data") +
                ": rods of finite width: expected thin needles, as an atom of a data file has a "
                "diameter, but no length beside it; a dump has both");
  Material rods = spheres;
  rods.length = {2};
  EXPECT_EQ(message("a.xml", rods),
            file("a.xml") +
                ": rods of finite width: expected thin needles or spheres, as DynamO knows no "
                "cylinders with caps");
  EXPECT_FALSE(std::ifstream(file("a.data")).is_open());
  EXPECT_FALSE(std::ifstream(file("a.xml")).is_open());
}

TEST_F(RodFormats, OfDynamoHaveSpheres) {
  State state = spinless(50);
  state.periodic[2] = false;
  Material material = spheres;
  material.walls = {test::wall("z", "both")};
  material.gravity = {0, 0, -1};
  const Configuration read = read_dynamo(put("a.xml", {state}, material));
  EXPECT_EQ(text_of(read.material), text_of(material).substr(0, text_of(read.material).size()));
  EXPECT_EQ(read.material.diameter, material.diameter);
  EXPECT_EQ(read.material.walls.size(), 2u);
  EXPECT_TRUE(read.notes.empty());
  EXPECT_EQ(read.state.velocity, state.velocity);
  EXPECT_EQ(read.state.orientation, state.orientation);
  EXPECT_EQ(read.state.angular_velocity, state.angular_velocity);
  for (std::size_t i = 0; i < state.size(); ++i)
    EXPECT_NEAR(read.state.position[i][2], state.position[i][2], 1e-14);
  const std::string text = text_of_file("a.xml");
  EXPECT_FALSE(test::contains(text, "Orientation"));
  expect_complaints(
      text,
      {{"Type=\"Point\"", "Type=\"Lines\" InertiaConstant=\"1\"",
        "line 16: Interaction Type = HardSphere: expected Lines, as of particles that turn"},
       {"Type=\"HardSphere\"", "Type=\"Lines\"",
        "line 16: Interaction Type = Lines: expected HardSphere, as of points"},
       {"HardSphere\" Diameter=\"1.3\"", "HardSphere\" Diameter=\"0\"",
        "line 16: Interaction Diameter = 0: expected a number > 0"},
       {"Elasticity=\"1\" Diameter=\"1.3\"", "Elasticity=\"1\" Diameter=\"2\"",
        "line 21: Local: Diameter 2: expected 1.3, that of the spheres"},
       {"Elasticity=\"1\" Diameter=\"1.3\"", "Elasticity=\"1\"",
        "line 21: Local: Diameter is missing: expected 1.3, that of the spheres"},
       {"<ParticleData>", "<ParticleData OrientationData=\"Y\">",
        "line 39: ParticleData OrientationData = Y: expected none: points do not turn"},
       {"<Pt ID=\"0\">", "<Pt ID=\"0\"><U x=\"0\" y=\"0\" z=\"1\"/>", "line 40: U: cannot be"}},
      [&](const std::string& bad) { return complaint(bad); });
}

}  // namespace
}  // namespace needlework::io
