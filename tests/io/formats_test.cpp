// Exports of frames: what is written is read back bit for bit, what cannot be read is named, and
// nothing is left after a failure.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "src/io/formats/columns.h"
#include "src/io/formats/export_formats.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/read_configuration.h"
#include "src/io/formats/xyz.h"
#include "tests/io/complaints.h"
#include "tests/io/dynamo_text.h"
#include "tests/io/exported_files.h"
#include "tests/io/support.h"
#include "tests/support/contains.h"
#include "tests/support/wall.h"

namespace needlework::io {
namespace {

using test::wall;

TEST_F(Formats, LastFrameIsReadBackBitForBit) {
  State plain = make_state(40, 3);
  plain.id.clear();
  plain.image.clear();
  for (const State& last : {make_state(100, 1), make_state(1, 2), plain}) {
    const std::vector<State> frames{make_state(7, 5), make_state(100, 6), last};
    const Configuration xyz = read_configuration(put("a.xyz", frames));
    expect_same(xyz.state, completed(last, false));
    EXPECT_EQ(text_of(xyz.material), text_of(material));
    const Configuration dump = read_configuration(put("a.dump", frames));
    expect_same(dump.state, completed(last, true));
    EXPECT_EQ(dump.material.length, material.length);
    EXPECT_EQ(dump.material.mass, material.mass);
    EXPECT_TRUE(dump.material.k.empty());
    const Configuration data = read_configuration(put("a.data", {last}));
    expect_same(data.state, completed(last, !last.image.empty()));
    EXPECT_EQ(text_of(data.material), text_of(material));
  }
}

TEST_F(Formats, MixturesAreReadBack) {
  const Material mixture{.names = {"a b,c", "long%", "none"},
                         .length = {1.1, 1.7, 3},
                         .mass = {2.5, 1, 4},
                         .k = {6, 3.3, 2},
                         .epsilon = {0.9, 0.8, 1, 0.8, 0.7, 1, 1, 1, 1},
                         .beta = {-1, 0.5, -1, 0.5, 0, -1, -1, -1, -1}};
  State state = make_state(20);
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.species.push_back(static_cast<SpeciesIndex>(i * i % 2));  // none of the third
  }
  for (const char* name : {"a.xyz", "a.dump", "a.data"}) {
    const Configuration read = read_configuration(put(name, {state}, mixture));
    expect_same(read.state, completed(state, name != std::string("a.xyz")));
    EXPECT_EQ(read.state.species, state.species) << name;
    if (name != std::string("a.dump")) {
      EXPECT_EQ(text_of(read.material), text_of(mixture)) << name;
      EXPECT_EQ(read.material.names, mixture.names);
      continue;
    }
    EXPECT_EQ(read.material.length, (std::vector{1.1, 1.7}));
    EXPECT_EQ(read.material.mass, (std::vector{2.5, 1.0}));
    EXPECT_EQ(read.material.k, (std::vector{6, 3.3}));
  }
}

TEST_F(Formats, TypesOfDumpsAreSpecies) {
  const auto read = [&](const char* rows) {
    std::ofstream(file("a.dump")) << lammps_dump(
        3, "type diameter x y z vx vy vz mux muy muz omegax omegay omegaz", rows);
    return read_configuration(file("a.dump"));
  };
  const std::string rest = " 1 2 3 4 5 6 1 0 0 0 7 8\n";
  const Configuration two = read(("2 1.5" + rest + "7 1" + rest + "2 1.5" + rest).c_str());
  EXPECT_EQ(two.state.species, (std::vector<SpeciesIndex>{0, 1, 0}));
  EXPECT_EQ(two.material.length, (std::vector{1.5, 1.0}));
  const Configuration one = read(("3 2" + rest + "3 2" + rest + "3 2" + rest).c_str());
  EXPECT_TRUE(one.state.species.empty());
  EXPECT_EQ(one.material.length, (std::vector{2.0}));
  const Configuration differing = read(("2 1.5" + rest + "7 1" + rest + "2 1" + rest).c_str());
  EXPECT_EQ(differing.state.own_bodies.length, (std::vector{1.5, 1.0, 1.0}));
  EXPECT_EQ(differing.material.length, (std::vector{1.25, 1.0}));
}

// As OVITO draws them: an ellipsoid along z, turned by a quaternion.
TEST_F(Formats, NeedlesAreDescribedAsRods) {
  State state = make_state(6);
  state.orientation[0] = {0, 0, 1};
  state.orientation[1] = {0, 0, -1};
  state.angular_velocity[0] = state.angular_velocity[1] = {0, 0, 0};
  const auto expect_rod = [&](std::size_t i, double w, double x, double y, double z) {
    const auto& u = state.orientation[i];
    EXPECT_NEAR(2 * (x * z + w * y), u[0], 2e-15);
    EXPECT_NEAR(2 * (y * z - w * x), u[1], 2e-15);
    EXPECT_NEAR(w * w - x * x - y * y + z * z, u[2], 2e-15);
    EXPECT_NEAR(w * w + x * x + y * y + z * z, 1, 2e-15);
  };
  // The numbers of each needle, from the column on.
  const auto numbers = [&](const std::string& name, std::size_t column) {
    std::istringstream text((put(name, {state}), text_of_file(name)));
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(text, line);) {
      std::istringstream words(line);
      std::vector<std::string> row;
      for (std::string word; words >> word;) row.push_back(word);
      if (row.size() < column + 7 || row[0] == "ITEM:") continue;
      rows.emplace_back();
      for (std::size_t i = column; i < column + 7; ++i) rows.back().push_back(std::stod(row[i]));
    }
    return rows;
  };
  const auto xyz = numbers("a.xyz", 14), dump = numbers("a.dump", 17);
  ASSERT_EQ(xyz.size(), state.size());
  ASSERT_EQ(dump.size(), state.size());
  EXPECT_TRUE(test::contains(text_of_file("a.xyz"), ":orientation:R:4:aspherical_shape:R:3 "));
  EXPECT_TRUE(
      test::contains(text_of_file("a.dump"), " quatw quati quatj quatk shapex shapey shapez "));
  for (std::size_t i = 0; i < state.size(); ++i) {
    expect_rod(i, xyz[i][3], xyz[i][0], xyz[i][1], xyz[i][2]);
    EXPECT_EQ(std::vector(xyz[i].begin() + 4, xyz[i].end()),
              (std::vector{0.02 * 1.7, 0.02 * 1.7, 0.85}));  // semi-axes
    expect_rod(i, dump[i][0], dump[i][1], dump[i][2], dump[i][3]);
    EXPECT_EQ(std::vector(dump[i].begin() + 4, dump[i].end()),
              (std::vector{0.04 * 1.7, 0.04 * 1.7, 1.7}));  // diameters
  }
}

// Files of earlier versions have the director under the name that OVITO takes for the quaternion.
TEST_F(Formats, DirectorsMayHaveTheNameOfOrientations) {
  for (const char* columns :
       {"director:R:3:a:R:4", "orientation:R:3:a:R:4", "director:R:3:orientation:R:4"}) {
    std::ofstream(file("a.xyz"))
        << "1\nLattice=\"8 0 0 0 9 0 0 0 10\" Properties=species:S:1:pos:R:3:velo:R:3:" << columns
        << ":angular_velocity:R:3\nX 1 2 3 4 5 6 1 0 0 9 9 9 9 0 7 8\n";
    EXPECT_EQ(read_configuration(file("a.xyz")).state.orientation[0],
              (std::array<double, 3>{1, 0, 0}));
  }
}

TEST_F(Formats, FramesWithoutNeedlesAreReadBack) {
  for (const char* name : {"a.xyz", "a.dump", "a.data"}) {
    const State state = read_configuration(put(name, {make_state(0)})).state;
    EXPECT_EQ(state.size(), 0u) << name;
    EXPECT_EQ(state.box, make_state(0).box);
  }
}

TEST_F(Formats, WhatIsNotKnownIsNotWritten) {
  const Configuration xyz = read_configuration(put("a.xyz", {make_state(2)}, {}));
  EXPECT_EQ(text_of(xyz.material), "");
  const Configuration dump = read_configuration(put("a.dump", {make_state(2)}, {}));
  EXPECT_EQ(text_of(dump.material), "");
}

TEST_F(Formats, FilesThatAreCutShortAreRefused) {
  for (const char* name : {"a.xyz", "a.dump", "a.data"}) {
    put(name, {make_state(3)});
    const std::string text = text_of_file(name);
    // Without the last two characters, the last number has another last digit at most.
    for (std::size_t size = 0; size + 2 < text.size(); size += 11) {
      const auto cut = text.substr(0, size);
      const std::size_t last_line = text.rfind('\n', text.size() - 2);
      if (size > last_line) break;
      EXPECT_FALSE(complaint(cut).empty()) << name << " " << size;
    }
  }
}

TEST_F(Formats, BadExtendedXyzIsNamed) {
  const std::string text =
      "2\nLattice=\"8 0 0 0 9 0 0 0 10\" "
      "Properties=species:S:1:pos:R:3:id:I:1:velo:R:3:orientation:R:3:angular_velocity:R:3\n"
      "X 1 2 3 0 4 5 6 1 0 0 0 7 8\nX 1 2 3 1 4 5 6 1 0 0 0 7 8\n";
  std::ofstream(file("a.xyz")) << text << "\n\n";
  EXPECT_EQ(read_xyz(file("a.xyz")).state.size(), 2u);
  expect_complaints(
      text,
      {{"2\n", "3\n", "cut short after line 4: expected the comment and 3 needles"},
       {"2\n", "1\n", "line 4: 14 words: expected the number of needles"},
       {"2\n", "99999999999999999999\n", "line 1: number of needles = 99999999999999999999: "},
       {"Lattice=", "lattice=", "line 2: Lattice is missing: expected a box"},
       {"8 0 0 0", "8 0 0", "line 2: Lattice of 8 numbers: expected 9"},
       {"8 0 0", "8 1 0", "line 2: Lattice with 1 in row 0, column 1: expected 0: a rectang"},
       {"9 0 0 0", "9 0 3 0", "line 2: tilt xz = 3: expected 0, as rows of boxes slide along x by"},
       {"9 0 0 0", "9 0 0 3", "line 2: tilt yz = 3: expected 0"},
       {"0 9 0", "nan 9 0",
        "line 2: Lattice with nan in row 1, column 0: expected a finite number"},
       {"Lattice", "shear_rate=x Lattice", "line 2: shear_rate = x: expected a finite number"},
       {"8 0 0", "-8 0 0", "line 2: Lattice with -8 in row 0, column 0: expected an edge > 0"},
       {"Properties=", "properties=", "line 2: Properties is missing: expected the names"},
       {":velo:R:3", ":a:R:3",
        "line 2: no velocity: expected the columns velo:R:3, velocities:R:3, or momenta:R:3 and"},
       {":orientation:R:3", ":orientation:R:2",
        "line 2: no orientation: expected the columns director:R:3, orientation:R:3 or, a"},
       {":velo:R:3", ":pos:R:3", "line 2: Properties with pos twice: expected different names"},
       {"Lattice", "k=3 Lattice=\"1 0 0 0 1 0 0 0 1\" Lattice",
        "line 2: Lattice twice: expected each key once"},
       {"Lattice", "a=1 a=2 Lattice", "line 2: a twice: expected each key once"},
       {"pos:R:3", "pos:R:x", "line 2: Properties with pos:R:x: expected NAME:TYPE:COLUMNS"},
       {"Lattice", "pbc=\"T T\" Lattice", "line 2: pbc = T T: expected T or F for each axis"},
       {"Lattice", "pbc=\"T T x\" Lattice", "line 2: pbc = T T x: expected T or F for each axis"},
       {"Lattice", "walls=z-top Lattice", "line 2: walls = z-top: expected such as z-low,z-high"},
       {"Lattice", "walls=z-low wall_epsilon=2 Lattice",
        "line 2: wall_epsilon = 2: expected a number from 0 to 1 for each of walls before"},
       {"Lattice", "gravity=0,1 Lattice", "line 2: gravity = 0,1: expected three numbers"},
       {"Lattice", "k=nan Lattice", "line 2: k = nan: expected a finite number"},
       {"X 1 2 3 0", "X 1 2 3 0 4", "line 3: 15 columns: expected 14"},
       {"X 1 2 3 0", "X 1 2 inf 0", "line 3: position z = inf: expected a finite number"},
       {"X 1 2 3 0", "X 1 2 3 -1", "line 3: id = -1: expected a whole number from 0 to"},
       {"X 1 2 3 0", "X 1 2 3 1", "id = 1 for two needles: expected different ids"},
       {"6 1 0 0", "6 1 1 0", "line 3: orientation = (1, 1, 0), of length 1.414"},
       {"0 7 8", "1 7 8", "line 3: angular velocity = (1, 7, 8), of which 0.09"}},
      [&](const std::string& bad) { return complaint(bad); });
}

TEST_F(Formats, BadDumpsAreNamed) {
  const std::string text =
      "ITEM: UNITS\nlj\nITEM: TIME\n0.5\nITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\n"
      "ITEM: BOX BOUNDS pp pp pp\n-4 4\n0 9\n1 11\n"
      "ITEM: ATOMS id vx vy vz x y z mux muy muz omegax omegay omegaz mass\n"
      "1 4 5 6 1 2 3 1 0 0 0 7 8 2\n2 4 5 6 1 2 3 1 0 0 0 7 8 2\n";
  std::ofstream(file("a.dump")) << text;
  const Configuration read = read_lammps_dump(file("a.dump"));
  EXPECT_EQ(read.state.box, (std::array<double, 3>{8, 9, 10}));
  EXPECT_EQ(read.state.position[0], (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(read.material.mass, std::vector<double>{2});
  expect_complaints(
      text,
      {{"ITEM: TIMESTEP", "ITEM: STEP", "cut short after line 15: expected ITEM: TIMESTEP"},
       {"pp pp pp", "pp pp ss", "line 9: ITEM: BOX BOUNDS pp pp ss: expected ITEM: BOX BOUNDS"},
       {"pp pp pp", "xy xz yz pp pp fm", "line 9: ITEM: BOX BOUNDS xy xz yz pp pp fm: expected"},
       {"pp pp pp", "xy xz yz pp pp pp", "line 10: expected the two bounds of the box and a tilt"},
       {"pp pp pp\n-4 4\n0 9", "xy xz yz pp pp pp\n-4 4 1\n0 9 0.5",
        "line 11: tilt xz = 0.5: expected 0, as rows of boxes slide along x by y alone (xy)"},
       {"pp pp pp\n-4 4\n0 9\n1 11", "xy xz yz pp pp pp\n-4 4 0\n0 9 0\n1 11 2",
        "line 12: tilt yz = 2: expected 0"},
       {"-4 4", "4 -4", "line 10: an edge of -8: expected one > 0"},
       {"-4 4", "-4", "line 10: expected the two bounds of the box"},
       {"ATOMS\n2", "ATOMS\n-2", "line 8: number of atoms = -2: expected a whole number"},
       {"ATOMS\n2", "ATOMS\n3", "cut short after line 15: expected 3 atoms"},
       {"ATOMS\n2", "ATOMS\n1", "line 15: expected no line after 1 atoms"},
       {"muz", "muw", "line 13: no orientation: expected the columns mux muy muz"},
       {"x y z mux", "x y q mux",
        "line 13: no position: expected the columns x y z, xs ys zs, xu yu zu or xsu ysu zsu"},
       {"vx vy vz x y z", "a b c x y w",
        "line 13: no position: expected the columns x y z, xs ys zs, xu yu zu or xsu ysu zsu; no "
        "velocity: expected the columns vx vy vz"},
       {"vx vy vz x y z", "vx vy vz x y y", "line 13: two columns y: expected different names"},
       {"8 2\n2", "8 -3\n2", "line 14: mass = -3: expected a number > 0"},
       {"\n2 4", "\n1 4", "id = 1 for two needles: expected different ids"},
       {"\n1 4", "\n0 4", "line 14: id = 0: expected a whole number from 1 to"}},
      [&](const std::string& bad) { return complaint(bad); });
}

// LAMMPS can write positions in four ways. In a box from -4 to 4, those of needles that have left
// it follow their paths.
TEST_F(Formats, DumpsMayHoldScaledAndUnwrappedPositions) {
  const auto text = [](const std::string& columns, const std::string& first) {
    return lammps_dump(1, "id " + columns + " vx vy vz mux muy muz omegax omegay omegaz",
                       "1 " + first + " 4 5 6 1 0 0 0 7 8\n", "pp pp pp", "-4 4\n0 9\n1 11\n");
  };
  const auto read = [&](const std::string& columns, const std::string& first) {
    std::ofstream(file("a.dump")) << text(columns, first);
    return read_configuration(file("a.dump")).state;
  };
  using Vector = std::array<double, 3>;
  using Images = std::vector<std::array<std::int32_t, 3>>;
  EXPECT_EQ(read("x y z", "-1 2 3").position[0], (Vector{-1, 2, 3}));
  EXPECT_EQ(read("xs ys zs", "0.375 0.25 0.125").position[0], (Vector{-1, 2.25, 2.25}));
  EXPECT_TRUE(read("xs ys zs", "0.375 0.25 0.125").image.empty());
  const State scaled = read("ix iy iz xs ys zs", "3 -4 0 0.375 0.25 0.125");
  EXPECT_EQ(scaled.position[0], (Vector{-1, 2.25, 2.25}));
  EXPECT_EQ(scaled.image, (Images{{3, -4, 0}}));
  const State unwrapped = read("xu yu zu", "23 -25 27.1");
  EXPECT_EQ(unwrapped.position[0], (Vector{-1, 2, 27.1 - 20}));
  EXPECT_EQ(unwrapped.image, (Images{{3, -3, 2}}));
  const State both = read("xsu ysu zsu", "3.375 -2.75 0.125");
  EXPECT_EQ(both.position[0], (Vector{-1, 2.25, 2.25}));
  EXPECT_EQ(both.image, (Images{{3, -3, 0}}));
  // Image counters beside unwrapped positions say the same a second time.
  EXPECT_EQ(read("ix iy iz xu yu zu", "3 -3 2 23 -25 27.1").image, unwrapped.image);
  // Wrapped positions come first.
  EXPECT_EQ(read("xu yu zu x y z", "23 -25 27.1 -1 2 7.5").position[0], (Vector{-1, 2, 7.5}));
  EXPECT_TRUE(complaint(text("xu yu zu", "1e30 0 0"))
                  .starts_with("line 10: position x = 1e+30: expected one at most 2147483647"));
  EXPECT_TRUE(complaint(text("xs ys zs", "1.7e308 0 0"))
                  .starts_with("line 10: position x = 1.7e+308: expected a number of boxes"));
}

// Between walls along y and z.
Material walled() {
  Material out = material;
  out.walls = {wall("z", "both", 0.5), wall("y", "high"), wall("y", "low", 0.25)};
  out.gravity = {0, -1, 0.5};
  return out;
}

State between_walls() {
  State state = completed(make_state(20, 3), true);
  state.periodic = {true, false, false};
  for (auto& image : state.image) image[1] = image[2] = 0;
  return state;
}

TEST_F(Formats, SayWhichAxesArePeriodicAndWhatEndsTheOthers) {
  const State state = between_walls();
  for (const char* name : {"a.xyz", "a.dump", "a.data"}) {
    const Configuration read = read_configuration(put(name, {state}, walled()));
    EXPECT_EQ(read.state.periodic, state.periodic) << name;
    EXPECT_EQ(read.state.position, state.position) << name;
    if (name == std::string("a.dump")) continue;  // which has no place for more
    ASSERT_EQ(read.material.walls.size(), 4u) << name;
    const char* sides[] = {"low", "high", "high", "low"};
    const double epsilon[] = {0.5, 0.5, 1, 0.25};
    for (std::size_t n = 0; n < 4; ++n) {
      EXPECT_EQ(read.material.walls[n].axis, n < 2 ? "z" : "y");
      EXPECT_EQ(read.material.walls[n].side, sides[n]);
      EXPECT_EQ(read.material.walls[n].epsilon, epsilon[n]);
    }
    EXPECT_EQ(read.material.gravity, walled().gravity);
  }
  EXPECT_TRUE(test::contains(text_of_file("a.xyz"), " pbc=\"T F F\""));
  EXPECT_TRUE(test::contains(text_of_file("a.dump"), "BOX BOUNDS pp ff ff\n"));
  Material open = walled();
  open.walls = {wall("z", "low"), wall("y", "high")};
  put("b.dump", {state}, open);
  EXPECT_TRUE(test::contains(text_of_file("b.dump"), "BOX BOUNDS pp sf fs\n"));
  const Configuration back = read_configuration(file("b.dump"));
  EXPECT_EQ(back.state.periodic, state.periodic);
  EXPECT_EQ(back.material.gravity, open.gravity);
  ASSERT_EQ(back.material.walls.size(), 2u);
  EXPECT_EQ(back.material.walls[0].axis + back.material.walls[0].side, "yhigh");
  EXPECT_EQ(back.material.walls[1].axis + back.material.walls[1].side, "zlow");
  ASSERT_EQ(back.notes.size(), 1u);
  EXPECT_TRUE(test::contains(back.notes[0], "epsilon = 1"));
  put("c.xyz", {make_state(3)});
  EXPECT_TRUE(test::contains(text_of_file("c.xyz"), " pbc=\"T T T\" length=1.7"));
  EXPECT_FALSE(test::contains(text_of_file("c.xyz"), "walls"));
}

// Forces of a dump are those of gravity if they give all needles the same acceleration.
TEST_F(Formats, DumpsHaveGravityAsForces) {
  std::string left_out;
  const auto gravity = [&](const std::string& boundary, const char* first, const char* second) {
    std::ofstream(file("a.dump")) << lammps_dump(
        2, "id type mass k x y z vx vy vz mux muy muz omegax omegay omegaz fx fy fz",
        "1 1 2 6 1 2 3 4 5 6 1 0 0 0 7 8 " + std::string(first) +
            "\n2 2 4 6 4 2 3 4 5 6 1 0 0 0 7 8 " + second + "\n",
        boundary, "0 9\n0 9\n0 9\n");
    const Configuration read = read_configuration(file("a.dump"));
    left_out = read.notes.empty() ? "" : read.notes.back();
    return read.material.gravity;
  };
  using Vector = std::array<double, 3>;
  EXPECT_EQ(gravity("pp pp fs", "0 0 -3", "0 0 -6"), (Vector{0, 0, -1.5}));
  EXPECT_EQ(gravity("pp pp ff", "0 0 -3", "0 0 -6"), (Vector{0, 0, -1.5}));
  EXPECT_EQ(gravity("pp pp fs", "0 0 -3", "0 0 -5.99998"), (Vector{0, 0, -1.5}));
  EXPECT_EQ(gravity("pp pp fs", "0 0 -3", "0 0 -3"), Vector{});  // not the same acceleration
  EXPECT_FALSE(test::contains(left_out, "[0"));
  EXPECT_EQ(gravity("pp pp fs", "1 0 -3", "2 0 -6"), Vector{});  // along a periodic axis
  EXPECT_TRUE(test::contains(left_out, "[0.5, 0, -1.5], along x too"));
  EXPECT_EQ(gravity("pp pp pp", "0 0 -3", "0 0 -6"), Vector{});
  EXPECT_TRUE(test::contains(left_out, "[0, 0, -1.5], along z too"));
}

// Along an axis with walls, the box begins at 0.
TEST_F(Formats, PositionsAreCountedFromTheLowWall) {
  std::ofstream(file("a.dump")) << lammps_dump(
      1, "id x y z ix iy iz vx vy vz mux muy muz omegax omegay omegaz",
      "1 -1 2 3 1 1 1 4 5 6 1 0 0 0 7 8\n", "pp pp ff", "-4 4\n0 9\n1 11\n");
  const State read = read_configuration(file("a.dump")).state;
  EXPECT_EQ(read.position[0], (std::array<double, 3>{-1, 2, 2}));
  EXPECT_EQ(read.image[0], (std::array<std::int32_t, 3>{1, 1, 0}));
}

// Bounds hold needles above an open side and behind a wall that has moved outwards; the edges are
// beside them.
TEST_F(Formats, BoundsEncloseWhatIsBeyondTheEdges) {
  State state = between_walls();
  const double edge = state.box[2], half = material.length[0] / 2;
  for (auto& position : state.position) position = {1, 2, 3};
  state.position[3][2] = edge + 2.5;
  state.position[4][2] = -0.25;
  Material open = material;
  open.walls = {wall("z", "low"), wall("y", "both")};
  for (const char* name : {"a.dump", "a.data"}) {
    const Configuration read = read_configuration(put(name, {state}, open));
    EXPECT_EQ(read.state.box, state.box) << name;
    EXPECT_EQ(read.state.position, state.position) << name;
    const std::string text = text_of_file(name);
    const std::string bounds = fmt::format("{} {}", -0.25 - half, edge + 2.5 + half);
    EXPECT_TRUE(test::contains(text, "\n" + bounds)) << name;
    EXPECT_TRUE(test::contains(text, fmt::format("\n0 {}", state.box[1]))) << name;
  }
  EXPECT_TRUE(
      test::contains(text_of_file("a.data"), fmt::format(" edges={}", fmt::join(state.box, ","))));
  state.position[3][2] = state.position[4][2] = 1;
  for (const char* name : {"b.dump", "b.data"}) {
    put(name, {state}, open);
    EXPECT_FALSE(test::contains(text_of_file(name), "edge")) << name;
  }
  EXPECT_TRUE(test::contains(complaint(replaced(text_of_file("a.data"), " edges=", " edges=-")),
                             "edges = -"));
}

TEST_F(Formats, BoxesWithTiltsOfZeroAreRectangular) {
  std::string dump = (put("a.dump", {make_state(3)}), text_of_file("a.dump"));
  const State wanted = read_configuration(file("a.dump")).state;
  dump = replaced(dump, "BOUNDS pp", "BOUNDS xy xz yz pp");
  const std::size_t bounds = dump.find("pp pp pp\n") + 9;
  for (std::size_t at = bounds, row = 0; row < 3; ++row) {
    at = dump.find('\n', at);
    dump.insert(at, row == 1 ? " -0.0" : " 0");
    at = dump.find('\n', at) + 1;
  }
  std::ofstream(file("b.dump")) << dump;
  expect_same(read_configuration(file("b.dump")).state, wanted);
  std::string data = (put("a.data", {make_state(3)}), text_of_file("a.data"));
  std::ofstream(file("b.data")) << replaced(data, "zlo zhi\n", "zlo zhi\n0.0 0 0 xy xz yz\n");
  expect_same(read_configuration(file("b.data")).state, read_configuration(file("a.data")).state);
}

TEST_F(Formats, ByteOrderMarksBlankLinesAndCarriageReturnsDoNotMatter) {
  for (const char* name : {"a.xyz", "a.dump", "a.data"}) {
    put(name, {make_state(5)});
    const Configuration wanted = read_configuration(file(name));
    const std::string text = text_of_file(name);
    std::string other = text;
    for (auto at = other.find('\n'); at != other.npos; at = other.find('\n', at + 2)) {
      other.insert(at, "\r");
    }
    for (const std::string& changed :
         {"\xef\xbb\xbf" + text, "\n" + text, "\xef\xbb\xbf \r\n\n" + text, other}) {
      std::ofstream(file("b"), std::ios::binary) << changed;
      const Configuration read = read_configuration(file("b"));
      expect_same(read.state, wanted.state);
      EXPECT_EQ(text_of(read.material), text_of(wanted.material)) << name;
    }
  }
}

// A file that another program has written with fewer digits.
TEST_F(Formats, WhatRoundingExplainsIsProjected) {
  const std::string head =
      "2\nLattice=\"8 0 0 0 9 0 0 0 10\" "
      "Properties=species:S:1:pos:R:3:velo:R:3:orientation:R:3:angular_velocity:R:3\n"
      "X 1 2 3 4 5 6 1 0 0 0 0.7 0.8\n";
  const auto read = [&](const std::string& second) {
    std::ofstream(file("a.xyz")) << head << "X 1 2 3 4 5 6 " << second << "\n";
    return read_configuration(file("a.xyz"));
  };
  const auto size = [](const std::array<double, 3>& a) { return std::hypot(a[0], a[1], a[2]); };
  // Nothing to project: the numbers are those of the file.
  const Configuration exact = read("0.6 0.8 0.0000005 0 0 1");
  EXPECT_EQ(exact.roundings.needles, 0u);
  EXPECT_EQ(exact.state.orientation[1], (std::array<double, 3>{0.6, 0.8, 0.0000005}));
  // A director with three digits, and an angular velocity that is normal to it within them.
  const Configuration rounded = read("0.577 0.577 0.578 1 -1 0.001");
  EXPECT_EQ(rounded.roundings.needles, 1u);
  EXPECT_NEAR(rounded.roundings.largest, 4e-4, 1e-4);
  const auto& u = rounded.state.orientation[1];
  const auto& w = rounded.state.angular_velocity[1];
  EXPECT_NEAR(size(u), 1, 1e-15);
  EXPECT_NEAR(u[0] * w[0] + u[1] * w[1] + u[2] * w[2], 0, 1e-16);
  EXPECT_NEAR(w[0], 1, 1e-3);
  // A rotation so slow that eight decimals are few for it.
  const Configuration slow =
      read("0.57735027 0.57735027 0.57735027 0.00000021 -0.00000020 0.00000000");
  EXPECT_EQ(slow.roundings.needles, 1u);
  EXPECT_LT(slow.roundings.largest, 1e-7);
  EXPECT_NEAR(slow.state.angular_velocity[1][0], 2.07e-7, 1e-9);
  for (const auto& [second, message] :
       {std::pair{"0.6 0.8 0.05 0 0 1",
                  "line 4: orientation = (0.6, 0.8, 0.05), of length 1.00124"},
        {"1 0 0 0.002 1 0", "line 4: angular velocity = (0.002, 1, 0), of which 0.00199"},
        // Six digits, of which none is wrong.
        {"1 0 0 2.1e-7 2e-7 0", "line 4: angular velocity = (2.1e-07, 2e-07, 0), of which 0.724"},
        {"1 0 0 0.4 0.3 0.0", "line 4: angular velocity = (0.4, 0.3, 0), of which 0.8"},
        {"1 0 0 0.04 0.30 0.00", "line 4: angular velocity = (0.04, 0.3, 0), of which 0.13"},
        // Rounding explains it, but it is large beside what the needles have.
        {"0.57735 0.57735 0.57735 0.01 -0.01 0.01", "line 4: angular velocity with 0.00577"}}) {
    const std::string found = complaint(head + "X 1 2 3 4 5 6 " + second + "\n");
    EXPECT_TRUE(found.starts_with(message)) << found;
  }
}

TEST_F(Formats, BadDataFilesAreNamed) {
  const std::string text =
      "title of kx\n\n2 atoms\n1 atom types\n\n0 8 xlo xhi\n0 9 ylo yhi\n0 10 zlo "
      "zhi\n\nMasses\n\n1 "
      "0\n\n"
      "Atoms # hybrid sphere dipole\n\n1 1 1 2 3 1 2 0 1 0 0\n2 1 1 2 3 1 2 0 1 0 0\n\n"
      "Velocities\n\n2 4 5 6 0 7 8\n1 4 5 7 0 7 8\n";
  std::ofstream(file("a.data")) << text;
  const Configuration read = read_lammps_data(file("a.data"));
  EXPECT_EQ(read.state.velocity[0], (std::array<double, 3>{4, 5, 7}));  // by its id
  expect_complaints(
      text,
      {{"2 atoms", "3 atoms", "line 18: 2 rows of Atoms: expected 3"},
       {"0 8 xlo", "0 -8 xlo", "line 6: an edge of -8: expected one > 0"},
       {"0 8 xlo xhi\n", "", "no bounds of the box: expected them"},
       {"zlo zhi", "zlo zhi\n0 0 0.5 xy xz yz", "line 9: tilt yz = 0.5: expected 0, as rows"},
       {"zlo zhi", "zlo zhi\n0.5 0 xy xz yz", "line 9: expected XY XZ YZ xy xz yz, three tilts"},
       {"# hybrid sphere dipole", "", "line 14: Atoms : expected Atoms # hybrid sphere dipole"},
       {"Masses", "Bonds", "line 10: Bonds: expected Atoms and Velocities only"},
       {"Velocities\n\n2", "Velocities\n\n3", "line 17: no velocity of atom 2: expected one"},
       {"Velocities\n\n2", "Velocities\n\n1", "line 22: a second velocity of atom 1: expected"},
       {"4 5 7 0 7 8", "4 5 7 0 7", "line 22: 6 columns: expected 7"},
       {"0 1 0 0\n2", "0 1 0 0 1\n2", "line 16: 12 columns: expected 11, or 14 with images"},
       {"\n1 1 1 2 3 1", "\n1 1 1 2 3 -2", "line 16: length = -2: expected a number > 0"}},
      [&](const std::string& bad) { return complaint(bad); });
  EXPECT_EQ(complaint("something\nelse\n"),
            "expected a configuration of DynamO, extended XYZ, or a dump or data file of LAMMPS");
}

TEST_F(Formats, NothingIsLeftOfAnExportThatFails) {
  for (const ExportFormat& format : export_formats()) {
    const std::string name = fmt::format("a{}", format.endings.front());
    const auto writer = format.open(file(name), false, material);
    if (format.name != "vtkhdf") writer->add({0, 0.0, make_state(3)});
  }
  EXPECT_EQ(files(), std::vector<std::string>{});
}

TEST_F(Formats, CollectionsKeepWhatIsThere) {
  std::filesystem::create_directory(file("a"));
  std::ofstream(file("a/mine")) << "mine";
  EXPECT_EQ(message_of<IoError>([&] {
              find_export_format("", "a.pvd", true)->open(file("a.pvd"), false, material);
            }),
            file("a") + ": exists already: expected a new name, or force to replace it");
  put("a.pvd", {make_state(3), make_state(3)});
  EXPECT_EQ(text_of_file("a/mine"), "mine");
  for (const char* name : {"a.pvd", "a/frame-00000.vtu", "a/frame-00001.vtu", "a/box-00000.vtu"}) {
    EXPECT_TRUE(std::filesystem::exists(file(name))) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(file("a/box-00001.vtu")));  // the same box
}

TEST_F(Formats, EndingsSayTheFormat) {
  const auto what = [](const char* name, const char* path, bool many) -> std::string {
    const ExportFormat* format = find_export_format(name, path, many);
    return format ? std::string(format->what) : "";
  };
  EXPECT_EQ(what("", "a.xml.bz2", false), "a configuration of DynamO");
  EXPECT_EQ(what("", "a.lammpstrj", false), "a dump of LAMMPS");
  EXPECT_EQ(what("", "a.txt", false), "");
  EXPECT_EQ(what("xyz", "a.pvd", false), "an extended XYZ file");
  EXPECT_EQ(what("lammps", "a.dump", false), "a dump of LAMMPS");
  EXPECT_EQ(what("lammps", "a.data", true), "a data file of LAMMPS");
  EXPECT_EQ(what("lammps", "a.txt", false), "a data file of LAMMPS");
  EXPECT_EQ(what("lammps", "a.txt", true), "a dump of LAMMPS");
}

}  // namespace
}  // namespace needlework::io
