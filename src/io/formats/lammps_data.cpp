#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "src/box/tilt.h"
#include "src/io/decimal.h"
#include "src/io/formats/bounds.h"
#include "src/io/formats/columns.h"
#include "src/io/formats/input_text.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/text_file.h"

namespace needlework::io {
namespace {

constexpr const char* style = "hybrid sphere dipole";

// A row of Atoms, id type x y z diameter density q mux muy muz ix iy iz, is followed by what the
// row of Velocities has after the id, vx vy vz wx wy wz. Images may be absent.
constexpr std::size_t atom_columns = 11;
constexpr std::size_t velocity_columns = 7;

Columns columns_of(bool with_images) {
  const std::size_t v = with_images ? atom_columns + 3 : atom_columns;
  Columns columns;
  columns.count = v + velocity_columns - 1;
  columns.id = 0;
  columns.species = 1;
  columns.first_species = 1;
  columns.first_id = 1;
  columns.position = {2, 3, 4};
  columns.bodies.length = 5;
  columns.orientation = {8, 9, 10};
  if (with_images) columns.image = {11, 12, 13};
  columns.velocity = {v, v + 1, v + 2};
  columns.angular_velocity = {v + 3, v + 4, v + 5};
  return columns;
}

class DataReader {
 public:
  DataReader(std::string_view text, const std::string& path) : lines_(text, path), path_(path) {}

  Configuration read();

 private:
  void read_title();
  void read_header_line();
  void read_section();
  std::vector<Row> read_rows(std::string_view section);

  Lines lines_;
  std::string path_;
  std::int64_t count_ = -1;
  std::array<double, 3> lower_{};
  double tilt_ = 0;
  std::optional<std::array<double, 3>> edges_;  // where the bounds are beyond them
  std::vector<Row> atoms_;
  std::unordered_map<std::string_view, Row> velocities_;  // by id
  Configuration configuration_;
};

Configuration DataReader::read() {
  read_title();
  while (lines_.advance_if_any()) {
    if (lines_.is_blank()) continue;
    const char first = lines_.fields()[0][0];
    if (first >= 'A' && first <= 'Z') {
      read_section();
    } else {
      read_header_line();
    }
  }
  const auto require = [&](bool found, const char* what) {
    if (!found) throw InputError(fmt::format("{}: no {}: expected them", path_, what));
  };
  require(count_ >= 0, "number of atoms");
  for (const double edge : configuration_.state.box) require(edge > 0, "bounds of the box");
  require(count_ == 0 || !atoms_.empty(), "Atoms");
  require(count_ == 0 || !velocities_.empty(), "Velocities");
  for (const Scene::Wall& wall : configuration_.material.walls) {
    configuration_.state.periodic[static_cast<std::size_t>(wall.axis[0] - 'x')] = false;
  }
  if (edges_) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (configuration_.state.periodic[axis]) continue;
      configuration_.state.box[axis] = (*edges_)[axis];
      lower_[axis] = 0;
    }
  }
  // All rows have as many columns as the first.
  const bool with_images = !atoms_.empty() && atoms_[0].fields.size() > atom_columns;
  Columns columns = columns_of(with_images);
  // Those of files without a mass in the title, as other programs write them.
  if (configuration_.material.mass.empty()) columns.bodies.density = 6;
  columns.lower = lower_;
  columns.tilt = tilt_;
  NeedleReader needles(columns, configuration_);
  for (Row& row : atoms_) {
    const auto velocity = velocities_.find(row.fields[0]);
    if (velocity == velocities_.end()) {
      row.reject(fmt::format("no velocity of atom {}: expected one", row.fields[0]));
    }
    const auto& further = velocity->second.fields;
    row.fields.insert(row.fields.end(), further.begin() + 1, further.end());
    needles.read(row);
  }
  needles.finish(path_);
  return std::move(configuration_);
}

// The first line whatever it says or, if that is blank, the next line with a word that is not the
// number of a header.
void DataReader::read_title() {
  lines_.advance("a title");
  if (lines_.is_blank() && lines_.advance_to_text()) {
    double number = 0;
    if (read_decimal(lines_.fields()[0], number) == std::errc()) {
      read_header_line();
      return;
    }
  }
  for (const std::string_view word : lines_.fields()) {
    const std::size_t equals = word.find('=');
    if (equals == word.npos) continue;
    const std::string_view name = word.substr(0, equals), value = word.substr(equals + 1);
    if (name == "edges") edges_ = read_edges(value, lines_.row());
    set_material(configuration_.material, name, value, lines_.row());
    set_flow(configuration_.state, name, value, lines_.row());
  }
}

// "NUMBER atoms" or "LOWER UPPER xlo xhi"; other numbers, such as that of atom types, do not
// matter.
void DataReader::read_header_line() {
  const Row& row = lines_.row();
  const auto& fields = row.fields;
  if (fields.size() >= 2 && fields[1] == "atoms") {
    if (count_ >= 0) row.reject("a second number of atoms: expected one");
    count_ = row.read_whole(0, "number of atoms", 0, most_needles);
  }
  if (const auto xy = std::ranges::find(fields, "xy"); xy != fields.end()) {
    if (xy - fields.begin() != 3) row.reject("expected XY XZ YZ xy xz yz, three tilts");
    tilt_ = row.read(0, "tilt xy");
    require_no_other_tilt(row.read(1, "tilt xz"), row.read(2, "tilt yz"), row);
  }
  constexpr const char* upper[] = {"xhi", "yhi", "zhi"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (fields.size() < 4 || fields[3] != upper[axis]) continue;
    lower_[axis] = row.read(0, "lower bound");
    const double edge = row.read(1, "upper bound") - lower_[axis];
    if (!(edge > 0)) row.reject(fmt::format("an edge of {}: expected one > 0", edge));
    configuration_.state.box[axis] = edge;
  }
}

void DataReader::read_section() {
  const std::string_view name = lines_.fields()[0];
  const std::string_view line = lines_.line();
  if (name == "Atoms") {
    // LAMMPS itself writes no more than the first word of the style.
    if (line.find(style) == line.npos && !line.ends_with("# hybrid")) {
      lines_.reject(fmt::format("{}: expected Atoms # {}", line.substr(0, 60), style));
    }
    if (!atoms_.empty()) lines_.reject("Atoms a second time: expected them once");
    atoms_ = read_rows(name);
    const std::size_t width = atoms_.empty() ? atom_columns : atoms_[0].fields.size();
    for (const Row& row : atoms_) {
      if (row.fields.size() == width && (width == atom_columns || width == atom_columns + 3))
        continue;
      row.reject(fmt::format("{} columns: expected {}, or {} with images, in all rows",
                             row.fields.size(), atom_columns, atom_columns + 3));
    }
  } else if (name == "Velocities") {
    for (Row& row : read_rows(name)) {
      if (row.fields.size() != velocity_columns) {
        row.reject(fmt::format("{} columns: expected {}", row.fields.size(), velocity_columns));
      }
      const std::string_view id = row.fields[0];
      if (!velocities_.emplace(id, row).second) {
        row.reject(fmt::format("a second velocity of atom {}: expected one", id));
      }
    }
  } else if (name != "Masses" && name != "Pair") {  // whose rows are passed over
    lines_.reject(fmt::format("{}: expected Atoms and Velocities only", name));
  }
}

std::vector<Row> DataReader::read_rows(std::string_view section) {
  if (count_ < 0) lines_.reject("no number of atoms before: expected it");
  lines_.advance("a blank line");
  if (!lines_.is_blank()) lines_.reject("expected a blank line");
  std::vector<Row> rows;
  for (std::int64_t i = 0; i < count_; ++i) {
    lines_.advance(fmt::format("{} rows of {}", count_, section));
    if (lines_.is_blank()) {
      lines_.reject(fmt::format("{} rows of {}: expected {}", i, section, count_));
    }
    rows.push_back(lines_.row());
  }
  return rows;
}

// k of each species, which the title says for all of its bodies.
std::vector<double> common_k(const std::vector<Species>& all, const State& state,
                             const std::string& path) {
  std::vector<double> out;
  for (const Species& each : all) out.push_back(each.k);
  std::vector<bool> is_known(all.size());
  for (std::size_t i = 0; i < state.own_bodies.inertia.size(); ++i) {
    const std::size_t species = species_at(state, i);
    const double k = body_at(all, state, i).k;
    if (!is_known[species]) out[species] = k;
    is_known[species] = true;
    if (std::abs(k - out[species]) <= 1e-12 * k) continue;
    throw InputError(fmt::format(
        "{}: k = m L^2 / (2 I) of {} and {}: expected one for each species, as an atom of a data "
        "file has no moment of inertia; a dump has one",
        path, out[species], k));
  }
  return out;
}

class DataWriter : public FrameWriter {
 public:
  DataWriter(const std::string& path, bool force, const Material& material)
      : path_(path), material_(material), all_(species_of(material)), file_(path, force) {}

  void add(const Frame& frame) override {
    const State& state = frame.state;
    const Bounds bounds = bounds_of(state, farthest_end(all_, state));
    file_.print("LAMMPS data file of needles: {}", title(state));
    if (!bounds.are_edges) file_.print(" edges={}", fmt::join(state.box, ","));
    if (frame.time) file_.print(" time={}", *frame.time);
    file_.print("{}", text_of_flow(state));
    file_.print("\n\n{} atoms\n{} atom types\n\n", state.size(), all_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      file_.print("{} {} {}lo {}hi\n", bounds.low[axis], bounds.high[axis], "xyz"[axis],
                  "xyz"[axis]);
    }
    if (const TiltedCell cell(state); cell.is_sheared())
      file_.print("{} 0 0 xy xz yz\n", cell.xy());
    write_atoms(state);
    file_.print("\nVelocities\n\n");
    for (std::size_t i = 0; i < state.size(); ++i) {
      const auto& v = state.velocity[i];
      const auto& w = state.angular_velocity[i];
      file_.print("{} {} {} {} {} {} {}\n", std::int64_t{id_of(state, i)} + 1, v[0], v[1], v[2],
                  w[0], w[1], w[2]);
    }
  }
  void publish() override { file_.publish(); }

 private:
  // Where bodies differ, masses are those of the densities.
  std::string title(const State& state) const {
    if (state.own_bodies.empty()) return text_of(material_);
    Material material = material_;
    material.mass.clear();
    material.k = common_k(all_, state, path_);
    return text_of(material);
  }

  void write_atoms(const State& state) {
    const TiltedCell cell(state);
    file_.print("\nAtoms # {}\n\n", style);
    for (std::size_t i = 0; i < state.size(); ++i) {
      const auto r = cell.position(i);
      const auto& u = state.orientation[i];
      const BodyOfRow body = body_at(all_, state, i);
      // LAMMPS derives the mass from that of a sphere.
      const double volume = std::numbers::pi / 6 * body.length * body.length * body.length;
      file_.print("{} {} {} {} {} {} {} 0 {} {} {}", std::int64_t{id_of(state, i)} + 1,
                  species_at(state, i) + 1, r[0], r[1], r[2], body.length, body.mass / volume, u[0],
                  u[1], u[2]);
      if (!state.image.empty()) {
        file_.print(" {}", fmt::join(cell.image(i), " "));
      }
      file_.print("\n");
    }
  }

  std::string path_;
  Material material_;
  std::vector<Species> all_;
  TextFile file_;
};

}  // namespace

bool is_lammps_data(std::string_view beginning) {
  Lines lines(beginning, "");
  if (!lines.advance_if_any()) return false;
  for (int i = 0; i < 20 && lines.advance_if_any(); ++i) {
    if (lines.fields().size() == 2 && lines.fields()[1] == "atoms") return true;
  }
  return false;
}

Configuration read_lammps_data(const std::string& path) {
  const std::string text = read_text_file(path);
  return DataReader(text, path).read();
}

std::unique_ptr<FrameWriter> write_lammps_data(const std::string& path, bool force,
                                               const Material& material) {
  if (has_width(material)) {
    throw InputError(
        fmt::format("{}: rods of finite width: expected thin needles, as an atom of a data file "
                    "has a diameter, but no length beside it; a dump has both",
                    path));
  }
  for (const Species& each : species_of(material)) {
    if (!each.fixed) continue;
    throw InputError(
        fmt::format("{}: the species {} is fixed: expected bodies that move, as LAMMPS reads no "
                    "infinite densities; a dump has infinite masses",
                    path, each.name));
  }
  return std::make_unique<DataWriter>(path, force, material);
}

}  // namespace needlework::io
