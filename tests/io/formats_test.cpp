// Exports of frames: what is written is read back bit for bit, what cannot be read is named, and
// nothing is left after a failure.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "src/io/formats/columns.h"
#include "src/io/formats/export_formats.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/read_configuration.h"
#include "src/io/formats/xyz.h"
#include "tests/io/complaints.h"
#include "tests/io/compressed.h"
#include "tests/io/dynamo_text.h"
#include "tests/io/support.h"

namespace needlework::io {
namespace {

const Material material{"needles", 1.7, 2.5, 3.3, 0.9, -0.25};

class Formats : public InFolder {
 protected:
  // Writes these frames under the name, in the format that its ending means.
  std::string put(const std::string& name, const std::vector<State>& states,
                  const Material& of = material) const {
    const ExportFormat* format = find_export_format("", name, false);
    const auto writer = format->open(file(name), true, of);
    for (std::size_t i = 0; i < states.size(); ++i) {
      writer->add({i, 0.1 * static_cast<double>(i), states[i]});
    }
    writer->publish();
    return file(name);
  }
  std::string text_of_file(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(file(name), std::ios::binary).rdbuf();
    return text.str();
  }
  std::string complaint(const std::string& text) const {
    std::ofstream(file("bad"), std::ios::binary) << text;
    const std::string message = message_of<InputError>([&] { read_configuration(file("bad")); });
    EXPECT_TRUE(message.starts_with(file("bad") + ": ")) << message;
    return message.substr(std::min(message.size(), file("bad").size() + 2));
  }
};

// Exports have no empty lists of ids and images.
State completed(State state, bool with_images) {
  state.image.resize(with_images ? state.size() : 0);
  if (state.id.empty()) {
    for (std::uint32_t i = 0; i < state.size(); ++i) state.id.push_back(i);
  }
  return state;
}

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
    EXPECT_EQ(dump.material.k, std::nullopt);
    const Configuration data = read_configuration(put("a.data", {last}));
    expect_same(data.state, completed(last, !last.image.empty()));
    EXPECT_EQ(text_of(data.material), text_of(material));
  }
}

// A block of 1 MiB ends within a line, and the last frame begins within a block.
TEST_F(Formats, FilesOfManyBlocksAreReadWhetherCompressedOrNot) {
  const State last = make_state(9000, 2);
  for (const char* name : {"a.xyz", "a.dump", "a.data"}) {
    std::vector<State> frames{make_state(12000, 1), last};
    if (name == std::string("a.data")) frames.erase(frames.begin());
    put(name, frames);
    const std::string text = text_of_file(name);
    ASSERT_GT(text.size(), std::size_t{1} << 20);
    const State expected = completed(last, name != std::string("a.xyz"));
    expect_same(read_configuration(file(name)).state, expected);
    std::ofstream(file("b"), std::ios::binary) << compressed(text);
    expect_same(read_configuration(file("b")).state, expected);
    if (frames.size() == 1) continue;  // whose needles are not in one line each
    const auto lines = std::count(text.begin(), text.end(), '\n');
    const auto place = fmt::format("line {}: ", lines);
    const std::string bad = text.substr(0, text.rfind(' ')) + " x\n";
    EXPECT_TRUE(complaint(bad).starts_with(place)) << complaint(bad);
    EXPECT_TRUE(complaint(compressed(bad)).starts_with(place)) << complaint(compressed(bad));
  }
}

TEST_F(Formats, FramesBeforeTheLastTakeNoMemory) {
  for (const char* name : {"a.xyz", "a.dump"}) {
    put(name, {make_state(1, 1)});
    const std::string one = text_of_file(name);
    {
      std::ofstream out(file("long"), std::ios::binary);
      for (std::size_t n = 0; n < (std::size_t{24} << 20) / one.size(); ++n) out << one;
    }
    const auto peak = [] {
      rusage usage;
      getrusage(RUSAGE_SELF, &usage);
      return usage.ru_maxrss;  // KiB
    };
    const auto before = peak();
    EXPECT_EQ(read_configuration(file("long")).state.size(), 1u);
    EXPECT_LT(peak() - before, 8 << 10);
  }
}

TEST_F(Formats, LinesThatDoNotFitABlockAreRefused) {
  const std::string spaces(std::size_t{1} << 20, ' ');
  for (const char* name : {"a.xyz", "a.dump"}) {
    put(name, {make_state(3)});
    const std::string text = text_of_file(name);
    const std::size_t second = text.find('\n') + 1;
    EXPECT_EQ(complaint(text.substr(0, second) + spaces + text.substr(second)),
              "line 2: more than 1048576 bytes: expected a shorter line");
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
       {"8 0 0", "-8 0 0", "line 2: Lattice with -8 in row 0, column 0: expected an edge > 0"},
       {"Properties=", "properties=", "line 2: Properties is missing: expected the names"},
       {":velo:R:3", ":a:R:3", "line 2: no velocity: expected columns of it"},
       {":orientation:R:3", ":orientation:R:4", "line 2: no orientation: expected columns"},
       {"pos:R:3", "pos:R:x", "line 2: Properties with pos:R:x: expected NAME:TYPE:COLUMNS"},
       {"Lattice", "pbc=\"T T F\" Lattice", "line 2: pbc = T T F: expected T T T, a periodic"},
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
  EXPECT_EQ(read.material.mass, 2);
  expect_complaints(
      text,
      {{"ITEM: TIMESTEP", "ITEM: STEP", "cut short after line 15: expected ITEM: TIMESTEP"},
       {"pp pp pp", "pp pp fs", "line 9: ITEM: BOX BOUNDS pp pp fs: expected ITEM: BOX BOUNDS"},
       {"pp pp pp", "xy xz yz pp pp pp", "line 9: ITEM: BOX BOUNDS xy xz yz pp pp pp: expected"},
       {"-4 4", "4 -4", "line 10: an edge of -8: expected one > 0"},
       {"-4 4", "-4", "line 10: expected the two bounds of the box"},
       {"ATOMS\n2", "ATOMS\n-2", "line 8: number of atoms = -2: expected a whole number"},
       {"ATOMS\n2", "ATOMS\n3", "cut short after line 15: expected 3 atoms"},
       {"ATOMS\n2", "ATOMS\n1", "line 15: expected no line after 1 atoms"},
       {"muz", "muw", "line 13: no orientation: expected columns of it"},
       {"8 2\n2", "8 3\n2", "line 15: mass = 2: expected 3, as of the needles before"},
       {"\n2 4", "\n1 4", "id = 1 for two needles: expected different ids"},
       {"\n1 4", "\n0 4", "line 14: id = 0: expected a whole number from 1 to"}},
      [&](const std::string& bad) { return complaint(bad); });
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
       {"zlo zhi", "zlo zhi\n0 0 0 xy xz yz", "line 9: a tilted box: expected a rectangular"},
       {"# hybrid sphere dipole", "", "line 14: Atoms : expected Atoms # hybrid sphere dipole"},
       {"Masses", "Bonds", "line 10: Bonds: expected Atoms and Velocities only"},
       {"Velocities\n\n2", "Velocities\n\n3", "line 17: no velocity of atom 2: expected one"},
       {"Velocities\n\n2", "Velocities\n\n1", "line 22: a second velocity of atom 1: expected"},
       {"4 5 7 0 7 8", "4 5 7 0 7", "line 22: 6 columns: expected 7"},
       {"0 1 0 0\n2", "0 1 0 0 1\n2", "line 16: 12 columns: expected 11, or 14 with images"},
       {"\n1 1 1 2 3 1", "\n1 1 1 2 3 2", "line 17: length = 1: expected 2, as of the needles"}},
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
