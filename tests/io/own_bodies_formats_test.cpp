// Bodies that differ within a species, and fixed ones, in H5MD and in the formats of other
// programs.
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "src/io/formats/columns.h"
#include "src/io/formats/dynamo.h"
#include "src/io/formats/lammps.h"
#include "tests/io/complaints.h"
#include "tests/io/exported_files.h"
#include "tests/support/contains.h"

namespace needlework::io {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class OwnBodiesFormats : public Formats {};

const Material two_species{.names = {"a", "b"},
                           .length = {1.1, 2},
                           .mass = {2.5, 1},
                           .k = {6, 3.3},
                           .epsilon = {0.9, 0.8, 0.8, 1},
                           .beta = {-1, -1, -1, -1}};

// Numbers with all bits in use, of which those of the second of two species are the same.
OwnBodies numbers_for(const State& state, double k = 0) {
  OwnBodies own;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const bool is_alike = !state.species.empty() && state.species[i] == 1;
    const double x = is_alike ? 0.1 : 1.0 / static_cast<double>(3 + i);
    own.length.push_back(0.3 + x);
    own.diameter.push_back(0.1 + x / 7);
    own.mass.push_back(std::exp(x));
    const double shape = own.mass[i] * (own.length[i] * own.length[i]);
    own.inertia.push_back(shape / (k > 0 ? 2 * k : 4 + std::sqrt(x)));
  }
  return own;
}

State differing(std::size_t count, bool of_two, double k = 0) {
  State state = make_state(count, 3);
  for (std::size_t i = 0; of_two && i < count; ++i)
    state.species.push_back(static_cast<SpeciesIndex>(i % 2));
  state.own_bodies = numbers_for(state, k);
  return state;
}

void expect_same_bodies(const OwnBodies& found, const OwnBodies& expected, const char* name) {
  EXPECT_EQ(found.length, expected.length) << name;
  EXPECT_EQ(found.diameter, expected.diameter) << name;
  EXPECT_EQ(found.mass, expected.mass) << name;
  EXPECT_EQ(found.inertia, expected.inertia) << name;
}

TEST_F(OwnBodiesFormats, AreReadBackBitForBit) {
  for (const bool of_two : {false, true}) {
    for (const bool wide : {false, true}) {
      Material its = of_two ? two_species : material;
      State state = differing(20, of_two);
      if (wide) its.diameter.assign(its.length.size(), 0.3);
      if (!wide) state.own_bodies.diameter.assign(state.size(), 0);
      for (const char* name : {"a.xyz", "a.dump"}) {
        const Configuration read =
            read_configuration(put(name, {differing(3, of_two), state}, its));
        expect_same_bodies(read.state.own_bodies, state.own_bodies, name);
        EXPECT_EQ(read.state.species, state.species) << name;
        EXPECT_EQ(has_width(read.material), wide) << name;
      }
    }
  }
}

// They turn about any axis.
TEST_F(OwnBodiesFormats, RoughSpheresKeepMomentsOfInertiaAndSpins) {
  Material its = two_species;
  its.length = {0, 0};
  its.diameter = {0.8, 1.1};
  its.inertia = {0.05, 0.3};
  its.beta = {0.5, 0.5, 0.5, 0.5};
  State alike = make_state(20, 3);
  for (std::size_t i = 0; i < 20; ++i) {
    alike.species.push_back(static_cast<SpeciesIndex>(i % 2));
    alike.angular_velocity[i] = {0.5, -1.0 / static_cast<double>(3 + i), 2};
  }
  State differing = alike;
  differing.own_bodies = numbers_for(alike);
  differing.own_bodies.length.assign(20, 0);
  for (const char* name : {"a.xyz", "a.dump"}) {
    for (const State& state : {alike, differing}) {
      const Configuration read = read_configuration(put(name, {state}, its));
      expect_same_bodies(read.state.own_bodies, state.own_bodies, name);
      EXPECT_EQ(read.state.angular_velocity, state.angular_velocity) << name;
      if (!state.own_bodies.empty()) continue;
      EXPECT_EQ(read.material.inertia, its.inertia) << name;
    }
  }
}

// LAMMPS has densities, from which masses follow, and one k for all.
TEST_F(OwnBodiesFormats, AreReadBackFromDataFilesButForARounding) {
  State state = differing(20, true, 3.3);
  state.own_bodies.diameter.assign(state.size(), 0);
  const Configuration read = read_configuration(put("a.data", {state}, two_species));
  EXPECT_FALSE(test::contains(text_of_file("a.data"), "mass="));
  const OwnBodies &found = read.state.own_bodies, &expected = state.own_bodies;
  EXPECT_EQ(found.length, expected.length);
  ASSERT_EQ(found.mass.size(), state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    EXPECT_NEAR(found.mass[i] / expected.mass[i], 1, 4e-16);
    EXPECT_NEAR(found.inertia[i] / expected.inertia[i], 1, 1e-12);
  }
  const std::string message = message_of<InputError>([&] { put("b.data", {differing(4, false)}); });
  EXPECT_TRUE(message.starts_with(file("b.data") + ": k = m L^2 / (2 I) of ")) << message;
}

// Other programs say no more than densities.
TEST_F(OwnBodiesFormats, DensitiesOfDataFilesSayMasses) {
  const std::string head =
      "a title\n\n2 atoms\n\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nAtoms # hybrid\n\n";
  const auto rows = [&](const std::string& first, const std::string& second) {
    return head + "1 1 1 2 3 " + first + " 0 1 0 0\n2 1 4 2 3 " + second +
           " 0 1 0 0\n\nVelocities\n\n1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n";
  };
  const auto read = [&](const std::string& text) {
    std::ofstream(file("a.data")) << text;
    return read_configuration(file("a.data"));
  };
  const double mass = 2 * (std::acos(-1) / 6);
  const Configuration alike = read(rows("1 2", "1 2"));
  ASSERT_EQ(alike.material.mass.size(), 1u);
  EXPECT_DOUBLE_EQ(alike.material.mass[0], mass);
  EXPECT_TRUE(alike.state.own_bodies.empty());
  const Configuration two = read(rows("1 2", "2 2"));
  EXPECT_EQ(two.state.own_bodies.length, (std::vector<double>{1, 2}));
  ASSERT_EQ(two.state.own_bodies.mass.size(), 2u);
  EXPECT_DOUBLE_EQ(two.state.own_bodies.mass[1], 8 * mass);
  EXPECT_EQ(complaint(rows("1 2", "1 0")), "line 12: density = 0: expected a number > 0");
}

TEST_F(OwnBodiesFormats, FixedOnesHaveInfiniteMasses) {
  Material its = two_species;
  its.mass = {2.5, infinity};
  State state = differing(10, true);
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (state.species[i] == 0) continue;
    state.own_bodies.mass[i] = state.own_bodies.inertia[i] = infinity;
    state.velocity[i] = state.angular_velocity[i] = {};
  }
  state.own_bodies.diameter.assign(state.size(), 0);
  State alike = state;
  alike.own_bodies = {};
  for (const State& each : {state, alike}) {
    for (const char* name : {"a.xyz", "a.dump"}) {
      const Configuration read = read_configuration(put(name, {each}, its));
      expect_same_bodies(read.state.own_bodies, each.own_bodies, name);
      const Composition composition = composition_of(read.material, name);
      EXPECT_FALSE(composition[0].fixed) << name;
      EXPECT_TRUE(composition[1].fixed) << name;
    }
  }
  for (const char* name : {"b.data", "b.xml"}) {
    EXPECT_TRUE(message_of<InputError>([&] {
                  put(name, {alike}, its);
                }).starts_with(file(name) + ": the species b is fixed: expected bodies that move"))
        << name;
  }
}

TEST_F(OwnBodiesFormats, DynamoRefusesThem) {
  EXPECT_EQ(message_of<InputError>([&] { put("a.xml", {differing(4, false)}); }),
            file("a.xml") +
                ": bodies of a species that differ: expected equal ones, as particles of a species "
                "are written with one mass and one size");
}

TEST_F(OwnBodiesFormats, LinesHaveLengthsMassesAndRadii) {
  Material its = material;
  its.diameter = {0.3};
  const State state = differing(3, false);
  put("a.vtkhdf", {state}, its);
  const std::vector<double> points = read_numbers(file("a.vtkhdf"), "/VTKHDF/Points");
  for (const char* name : {"length", "mass", "radius"})
    ASSERT_EQ(read_numbers(file("a.vtkhdf"), std::string("/VTKHDF/PointData/") + name).size(), 6u);
  const auto lengths = read_numbers(file("a.vtkhdf"), "/VTKHDF/PointData/length");
  const auto masses = read_numbers(file("a.vtkhdf"), "/VTKHDF/PointData/mass");
  const auto radii = read_numbers(file("a.vtkhdf"), "/VTKHDF/PointData/radius");
  for (std::size_t n = 0; n < 6; ++n) {
    EXPECT_EQ(lengths[n], state.own_bodies.length[n / 2]);
    EXPECT_EQ(masses[n], state.own_bodies.mass[n / 2]);
    EXPECT_EQ(radii[n], state.own_bodies.diameter[n / 2] / 2);
  }
  const double* tail = &points[6];
  EXPECT_NEAR(std::hypot(tail[3] - tail[0], tail[4] - tail[1], tail[5] - tail[2]), lengths[2],
              1e-14);
}

// OVITO draws each as it is.
TEST_F(OwnBodiesFormats, HaveShapesOfTheirOwn) {
  State state = differing(2, false);
  state.own_bodies.length = {1, 2};
  state.own_bodies.diameter = {0.25, 0.5};
  Material its = material;
  its.diameter = {0.3};
  put("a.xyz", {state}, its);
  EXPECT_TRUE(test::contains(text_of_file("a.xyz"), " 0.125 0.125 1 1 "));
  EXPECT_TRUE(test::contains(text_of_file("a.xyz"), " 0.25 0.25 2 2 "));
  put("a.dump", {state}, its);
  EXPECT_TRUE(test::contains(text_of_file("a.dump"), " 0.5 0.5 4 2 0.5 "));
}

std::string dump_of_two(const std::string& columns, const std::string& first,
                        const std::string& second) {
  const std::string rest = " 2 3 4 5 6 1 0 0 0 7 8 ";
  return lammps_dump(2, "type x y z vx vy vz mux muy muz omegax omegay omegaz " + columns,
                     "1 1" + rest + first + "\n1 4" + rest + second + "\n");
}

TEST_F(OwnBodiesFormats, OfOtherProgramsMayDifferInAnything) {
  const auto read = [&](const std::string& columns, const std::string& first,
                        const std::string& second) {
    std::ofstream(file("a.dump")) << dump_of_two(columns, first, second);
    return read_configuration(file("a.dump")).state.own_bodies;
  };
  const OwnBodies lengths = read("diameter", "1", "2");
  EXPECT_EQ(lengths.length, (std::vector<double>{1, 2}));
  EXPECT_EQ(lengths.mass, (std::vector<double>{1, 1}));
  EXPECT_EQ(lengths.inertia, (std::vector<double>{1.0 / 12, 4.0 / 12}));
  const OwnBodies masses = read("mass k", "3 2", "6 2");
  EXPECT_EQ(masses.mass, (std::vector<double>{3, 6}));
  EXPECT_EQ(masses.inertia, (std::vector<double>{0.75, 1.5}));
  const OwnBodies rods = read("length diameter mass", "1 0.5 2", "1 1 2");
  EXPECT_EQ(rods.inertia[1], 2 / (2 * homogeneous_k(1, 1)));
  const OwnBodies spheres = read("length diameter mass inertia", "0 0.5 2 0", "0 1 2 0");
  EXPECT_EQ(spheres.diameter, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(spheres.inertia, (std::vector<double>{0, 0}));
  EXPECT_TRUE(read("mass inertia", "3 0.5", "3 0.5").empty());
}

TEST_F(OwnBodiesFormats, BadNumbersAreNamedWithTheirLine) {
  const std::string text =
      dump_of_two("length diameter mass inertia", "1 0.5 2 0.1", "2 0.7 3 0.2");
  expect_complaints(
      text,
      {{"2 0.7 3 0.2", "2 0.7 0 0.2", "line 11: mass = 0: expected a number > 0"},
       {"2 0.7 3 0.2", "2 0.7 nan 0.2", "line 11: mass = nan: expected a finite number"},
       {"2 0.7 3 0.2", "2 0.7 inf 0.2",
        "line 11: mass = inf: expected a finite number, as for others of its species"},
       {"1 0.5 2 0.1", "1 0.5 inf inf",
        "line 11: mass = 3: expected infinity, as for others of its species"},
       {"2 0.7 3 0.2", "0 0.7 3 0.2",
        "line 11: length = 0: expected a number > 0, as for others of its species"},
       {"2 0.7 3 0.2", "inf 0.7 3 0.2", "line 11: length = inf: expected a finite number"},
       {"2 0.7 3 0.2", "-1 0.7 3 0.2", "line 11: length = -1: expected a number > 0, or 0 for a"},
       {"2 0.7 3 0.2", "2 0 3 0.2", "line 11: diameter = 0: expected a number > 0"},
       {"2 0.7 3 0.2", "2 0.7 3 -0.2", "line 11: inertia = -0.2: expected a number > 0"},
       {"2 0.7 3 0.2", "2 0.7 3 x", "line 11: inertia = x: expected a finite number"}},
      [&](const std::string& bad) { return complaint(bad); });
}

TEST_F(OwnBodiesFormats, NumbersOfAllNeedlesMustBeThoseOfTheComment) {
  const auto text = [](const std::string& masses) {
    return "2\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3:velo:R:3:director:R:3:"
           "angular_velocity:R:3:masses:R:1 mass=2\nX 1 2 3 0 0 0 1 0 0 0 0 0 " +
           masses.substr(0, 1) + "\nX 4 2 3 0 0 0 1 0 0 0 0 0 " + masses.substr(2) + "\n";
  };
  EXPECT_EQ(complaint(text("3 3")),
            "line 3: mass = 3: expected 2, as the file says of its species");
  std::ofstream(file("a.xyz")) << text("3 4");
  const Configuration read = read_configuration(file("a.xyz"));
  EXPECT_EQ(read.state.own_bodies.mass, (std::vector<double>{3, 4}));
  EXPECT_EQ(read.material.mass, std::vector<double>{3.5});
}

TEST_F(OwnBodiesFormats, MomentaAreDividedByTheirOwnMasses) {
  std::ofstream(file("a.xyz"))
      << "2\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3:momenta:R:3:director:R:3:"
         "angular_velocity:R:3:masses:R:1\nX 1 2 3 2 4 6 1 0 0 0 0 0 2\nX 4 2 3 2 4 6 1 0 0 0 0 0 "
         "4\n";
  const State state = read_configuration(file("a.xyz")).state;
  EXPECT_EQ(state.velocity[0], (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(state.velocity[1], (std::array<double, 3>{0.5, 1, 1.5}));
}

TEST_F(OwnBodiesFormats, H5mdHoldsThemBitForBit) {
  Scene scene = make_scene(6);
  scene.needles.diameter = 0.2;
  const State state = differing(6, false);
  RunInfo run{"scalar", 1, 1};
  run.own_bodies = state.own_bodies;
  Writer writer(file("a.h5"), false, scene, run);
  writer.write_frame({}, state);
  writer.close();
  expect_same_bodies(read_last_frame(file("a.h5")).own_bodies, state.own_bodies, "a.h5");
}

TEST_F(OwnBodiesFormats, BadNumbersOfH5mdAreNamedWithTheirRow) {
  const auto message = [&](const std::string& name, const std::vector<double>& values) {
    const std::string path = make([&](HandMade& made) {
      made.put("/particles/all/length", {2}, {1, 2});
      made.put("/particles/all/" + name, {values.size()}, values);
    });
    return message_of<InputError>([&] { read_last_frame(path); });
  };
  const auto of = [&](const std::string& rest) {
    return file("made.h5") + ": /particles/all/" + rest;
  };
  EXPECT_EQ(message("length", {1, -2}), of("length[1] = -2: expected a finite number >= 0"));
  EXPECT_EQ(message("length", {infinity, 1}), of("length[0] = inf: expected a finite number >= 0"));
  EXPECT_EQ(message("mass", {1, 0}), of("mass[1] = 0: expected a number > 0"));
  EXPECT_EQ(message("mass", {std::nan(""), 1}), of("mass[0] = nan: expected a number > 0"));
  EXPECT_EQ(message("inertia", {-1, 1}), of("inertia[0] = -1: expected a number >= 0"));
  EXPECT_EQ(message("diameter", {1, 1, 1}),
            of("diameter: 3 numbers: expected 2, one for each needle"));
  const std::string path = make([&](HandMade& made) {
    made.put("/particles/all/length", {2}, {1, 2});
    made.put("/particles/all/mass", {2}, {1, infinity});
  });
  EXPECT_EQ(read_last_frame(path).own_bodies.mass, (std::vector<double>{1, infinity}));
}

}  // namespace
}  // namespace needlework::io
