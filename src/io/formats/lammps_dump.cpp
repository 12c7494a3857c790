#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "src/box/tilt.h"
#include "src/io/decimal.h"
#include "src/io/formats/bounds.h"
#include "src/io/formats/columns.h"
#include "src/io/formats/input_text.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/rod.h"
#include "src/io/formats/text_file.h"

namespace needlework::io {
namespace {

constexpr std::string_view begin_of_frame = "ITEM: TIMESTEP";
constexpr std::string_view begin_of_box = "ITEM: BOX BOUNDS";
constexpr std::string_view begin_of_atoms = "ITEM: ATOMS";

// Units are said once, times of frames before their time steps.
bool begins_next_frame(std::string_view line) {
  return line.starts_with(begin_of_frame) || line.starts_with("ITEM: TIME") ||
         line.starts_with("ITEM: UNITS");
}

constexpr ColumnNames dump_names{
    "x y z, xs ys zs, xu yu zu or xsu ysu zsu", "vx vy vz",
    "mux muy muz or, of a quaternion, quatw quati quatj quatk or c_q[1] to c_q[4]",
    "omegax omegay omegaz or angmomx angmomy angmomz"};

// The four numbers that a compute, a fix or a variable gives of each atom, such as c_q[1] to
// c_q[4]; nothing where there are not four of them.
std::optional<QuaternionColumns> find_four_numbers(const Lines& lines) {
  const auto& words = lines.fields();
  const auto find = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(words, name) - words.begin());
  };
  std::optional<QuaternionColumns> found;
  for (std::size_t n = 2; n < words.size(); ++n) {
    if (!words[n].starts_with("c_") && !words[n].starts_with("f_") && !words[n].starts_with("v_"))
      continue;
    if (!words[n].ends_with("[1]")) continue;
    const std::string name(words[n].substr(0, words[n].size() - 3));
    const auto at = [&](int i) { return find(fmt::format("{}[{}]", name, i)); };
    if (at(4) == words.size() || at(5) != words.size()) continue;
    if (at(2) == words.size() || at(3) == words.size()) continue;
    if (found) {
      lines.reject(
          fmt::format("several columns of four numbers, {}[1] among them: expected those "
                      "of one quaternion, or quatw quati quatj quatk",
                      name));
    }
    found = {n - 2, at(2) - 2, at(3) - 2, at(4) - 2};
  }
  return found;
}

// Periodic, or with a fixed end (f) or two. A boundary that follows the atoms (s) is an open side
// opposite to a wall; one that is not closer than some bound (m) is none of needles.
bool is_rectangular(const std::vector<std::string_view>& words, std::size_t first_boundary) {
  return words.size() == first_boundary + 3 &&
         std::all_of(words.begin() + static_cast<std::ptrdiff_t>(first_boundary), words.end(),
                     [](std::string_view word) {
                       return word == "pp" || word == "ff" || word == "fs" || word == "sf";
                     });
}

// Where a side is open, the boundary says on which sides there are walls.
void add_walls(std::span<const std::string_view> boundary, Configuration& configuration) {
  if (std::ranges::none_of(boundary, [](auto word) { return word == "fs" || word == "sf"; })) {
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (boundary[axis] == "pp") continue;
    Scene::Wall& wall = configuration.material.walls.emplace_back();
    wall.axis = std::string(1, "xyz"[axis]);
    wall.side = boundary[axis] == "ff" ? "both" : boundary[axis] == "fs" ? "low" : "high";
  }
  configuration.notes.push_back(
      "it says where walls are, not which: at rest with epsilon = 1 are assumed");
}

// Forces that give all needles the same acceleration are those of gravity.
class Gravity {
 public:
  void add(const Row& row, const VectorColumns& columns, double mass) {
    std::array<double, 3> acceleration{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      acceleration[axis] = row.read(columns[axis], "force") / mass;
    }
    if (!first_) first_ = acceleration;
    const auto& [x, y, z] = *first_;
    const double size = std::abs(x) + std::abs(y) + std::abs(z);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // LAMMPS writes six digits.
      is_same_ &= std::abs(acceleration[axis] - (*first_)[axis]) <= 1e-5 * size;
    }
  }
  /// Along axes with walls. What acts along a periodic axis too needs thermal walls, of which a
  /// dump does not say that they are: it is left out, with a note.
  std::array<double, 3> along_walls(const std::array<bool, 3>& periodic,
                                    std::vector<std::string>& notes) const {
    if (!first_ || !is_same_) return {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!periodic[axis] || (*first_)[axis] == 0) continue;
      notes.push_back(
          fmt::format("its forces accelerate all needles by [{}], along {} too, which is periodic: "
                      "they are left "
                      "out; beside thermal walls, forces.gravity in the scene says them",
                      fmt::join(*first_, ", "), "xyz"[axis]));
      return {};
    }
    return *first_;
  }

 private:
  std::optional<std::array<double, 3>> first_;
  bool is_same_ = true;
};

struct Corner {
  std::array<double, 3> lower{};
  double tilt = 0;  // xy
};

// Sets the edges and which axes are periodic. The bounds of a tilted box are those of all that is
// in it.
Corner read_box(Lines& lines, Configuration& configuration) {
  State& state = configuration.state;
  const std::vector<std::string_view> words = lines.fields();
  const bool tilted = words.size() > 5 && words[3] == "xy" && words[4] == "xz" && words[5] == "yz";
  if (!is_rectangular(words, tilted ? 6 : 3)) {
    lines.reject(
        fmt::format("{}: expected {} pp pp pp, with ff along axes between two walls, fs or "
                    "sf where one side is open",
                    lines.line().substr(0, 60), begin_of_box));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    state.periodic[axis] = words[(tilted ? 6 : 3) + axis] == "pp";
  }
  add_walls(std::span(words).last(3), configuration);
  Corner corner;
  std::array<double, 3> tilts{};  // xy, xz, yz
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lines.advance("the bounds of the box");
    const Row& row = lines.row();
    if (row.fields.size() != (tilted ? 3 : 2)) {
      row.reject(tilted ? "expected the two bounds of the box and a tilt"
                        : "expected the two bounds of the box");
    }
    if (tilted) tilts[axis] = row.read(2, "tilt");
    const double tilt = axis == 0 ? tilts[0] : 0;
    corner.lower[axis] = row.read(0, "lower bound") - std::min(0.0, tilt);
    const double edge = row.read(1, "upper bound") - std::max(0.0, tilt) - corner.lower[axis];
    require_no_other_tilt(tilts[1], tilts[2], row);
    if (!(edge > 0)) row.reject(fmt::format("an edge of {}: expected one > 0", edge));
    state.box[axis] = edge;
  }
  corner.tilt = tilts[0];
  return corner;
}

Columns read_columns(const Lines& lines) {
  const auto& words = lines.fields();  // "ITEM:" "ATOMS" and the names
  Columns columns;
  columns.first_id = 1;
  columns.count = words.size() - 2;
  for (auto word = words.begin() + 2; word != words.end(); ++word) {
    if (std::find(words.begin() + 2, word, *word) == word) continue;
    lines.reject(fmt::format("two columns {}: expected different names", *word));
  }
  const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
    const auto found = std::find(words.begin() + 2, words.end(), name);
    if (found == words.end()) return {};
    return static_cast<std::size_t>(found - words.begin()) - 2;
  };
  const auto find_vector = [&](std::string_view x, std::string_view y,
                               std::string_view z) -> std::optional<VectorColumns> {
    const auto a = find(x), b = find(y), c = find(z);
    return a && b && c ? std::optional(VectorColumns{*a, *b, *c}) : std::nullopt;
  };
  columns.id = find("id");
  columns.position = find_vector("x", "y", "z");
  if (!columns.position) {
    columns.position = find_vector("xs", "ys", "zs");
    columns.scaled = columns.position.has_value();
  }
  if (!columns.position) {
    columns.position = find_vector("xu", "yu", "zu");
    columns.unwrapped = columns.position.has_value();
  }
  if (!columns.position) {
    columns.position = find_vector("xsu", "ysu", "zsu");
    columns.scaled = columns.unwrapped = columns.position.has_value();
  }
  columns.image = find_vector("ix", "iy", "iz");
  columns.velocity = find_vector("vx", "vy", "vz");
  columns.orientation = find_vector("mux", "muy", "muz");
  if (const auto w = find("quatw"), i = find("quati"), j = find("quatj"), k = find("quatk");
      w && i && j && k) {
    columns.quaternion = {*w, *i, *j, *k};
  } else if (!columns.orientation) {
    columns.quaternion = find_four_numbers(lines);
  }
  columns.angular_velocity = find_vector("omegax", "omegay", "omegaz");
  columns.angular_momentum = find_vector("angmomx", "angmomy", "angmomz");
  BodyPlaces& bodies = columns.bodies;
  bodies.length = find("length");
  (bodies.length ? bodies.diameter : bodies.length) = find("diameter");
  bodies.mass = find("mass");
  bodies.k = find("k");
  bodies.inertia = find("inertia");
  columns.species = find("type");
  columns.first_species = 1;
  columns.force = find_vector("fx", "fy", "fz");
  columns.edges = find_vector("edgex", "edgey", "edgez");
  require_all_vectors(columns, dump_names, lines.row());
  return columns;
}

// The last one if none is asked for.
PartOfFile find_dump_frame(InputText& file, const std::string& path,
                           std::optional<std::size_t> wanted) {
  Lines lines(file, path);
  PartOfFile last;
  std::size_t frames = 0;
  while (lines.pass_if_any()) {
    if (!lines.line().starts_with(begin_of_frame)) continue;
    if (wanted && frames > *wanted) break;
    last.begin = lines.place();
    last.number = frames++;
  }
  if (wanted && frames <= *wanted) refuse_frame(path, *wanted, frames);
  if (frames == 0) last.begin = lines.next_place();
  last.end = lines.next_place().offset;
  return last;
}

class DumpWriter : public FrameWriter {
 public:
  DumpWriter(const std::string& path, bool force, const Material& material)
      : material_(material), all_(species_of(material)), file_(path, force) {
    for (std::size_t n = 0; n < all_.size(); ++n) {
      const Species& each = all_[n];
      endings_.push_back(ending_of({each.length, each.diameter, each.mass_or_infinity(), each.k,
                                    number_of(material_.inertia, n, each.inertia())},
                                   false));
    }
  }

  void add(const Frame& frame) override {
    const State& state = frame.state;
    const auto boundary = [&](std::size_t axis) { return lammps_boundary(state, material_, axis); };
    const TiltedCell cell(state);
    Bounds bounds = bounds_of(state, farthest_end(all_, state));
    if (cell.is_sheared()) bounds.include(cell.xy(), state.box);
    file_.print("{}\n{}\nITEM: NUMBER OF ATOMS\n{}\n{}{} {} {} {}\n", begin_of_frame, frame.number,
                state.size(), begin_of_box, cell.is_sheared() ? " xy xz yz" : "", boundary(0),
                boundary(1), boundary(2));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      file_.print("{} {}", bounds.low[axis], bounds.high[axis]);
      if (cell.is_sheared()) file_.print(" {}", axis == 0 ? cell.xy() : 0.0);
      file_.print("\n");
    }
    const bool are_own = !state.own_bodies.empty();
    const std::string edges = bounds.are_edges ? "" : fmt::format(" {}", fmt::join(state.box, " "));
    file_.print(
        "{} id type x y z ix iy iz vx vy vz mux muy muz omegax omegay omegaz quatw quati quatj "
        "quatk shapex shapey shapez{}{}\n",
        begin_of_atoms, names(are_own), bounds.are_edges ? "" : " edgex edgey edgez");
    for (std::size_t i = 0; i < state.size(); ++i) {
      const auto r = cell.position(i);
      const auto& v = state.velocity[i];
      const auto& u = state.orientation[i];
      const auto& w = state.angular_velocity[i];
      const auto image = cell.image(i);
      const auto q = quaternion_of(u);
      const std::size_t species = species_at(state, i);
      file_.print("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}{}{}\n",
                  std::int64_t{id_of(state, i)} + 1, species + 1, r[0], r[1], r[2], image[0],
                  image[1], image[2], v[0], v[1], v[2], u[0], u[1], u[2], w[0], w[1], w[2], q[0],
                  q[1], q[2], q[3],
                  are_own ? ending_of(body_at(all_, state, i), true) : endings_.at(species), edges);
    }
  }
  void publish() override { file_.publish(); }

 private:
  bool is_wide() const { return has_width(material_); }
  bool has_lengths(bool are_own) const { return is_wide() || !material_.length.empty() || are_own; }
  bool has_masses(bool are_own) const { return !material_.mass.empty() || are_own; }
  bool has_k(bool are_own) const { return !are_own && (is_wide() || all_.size() > 1); }
  bool has_inertia(bool are_own) const { return are_own || !material_.inertia.empty(); }
  bool has_forces() const { return material_.gravity != std::array<double, 3>{}; }

  // Of the columns of ending_of(), after the shape. Moments of inertia say more digits than k.
  std::string names(bool are_own) const {
    std::string out;
    if (is_wide()) out += " length";
    if (has_lengths(are_own)) out += " diameter";
    if (has_masses(are_own)) out += " mass";
    if (has_k(are_own)) out += " k";
    if (has_inertia(are_own)) out += " inertia";
    if (has_forces()) out += " fx fy fz";
    return out;
  }

  // Of the line of a needle.
  std::string ending_of(const BodyOfRow& body, bool are_own) const {
    std::string out;
    const auto add = [&](double number) { out += fmt::format(" {}", number); };
    // Diameters of an ellipsoid, as LAMMPS has them; OVITO halves them.
    for (const double semi_axis : drawn_shape(body.length, body.diameter, are_spheres(material_)))
      add(2 * semi_axis);
    if (has_lengths(are_own)) add(body.length);
    if (is_wide()) add(body.diameter);
    if (has_masses(are_own)) add(body.mass);
    if (has_k(are_own)) add(body.k);
    if (has_inertia(are_own)) add(body.inertia);
    for (const double g : material_.gravity) {
      if (has_forces()) add(body.mass * g);
    }
    return out;
  }

  Material material_;
  std::vector<Species> all_;
  std::vector<std::string> endings_;  // of a line, for each species of equal bodies
  TextFile file_;
};

}  // namespace

std::string lammps_boundary(const State& state, const Material& material, std::size_t axis) {
  if (state.periodic[axis]) return "pp";
  const bool low = wall_at(material, axis, false), high = wall_at(material, axis, true);
  if (low == high) return "ff";
  return low ? "fs" : "sf";
}

bool is_lammps_dump(std::string_view beginning) {
  Lines lines(beginning, "");
  return lines.advance_to_text() && lines.line().starts_with("ITEM: ");
}

Configuration read_lammps_dump(const std::string& path, std::optional<std::size_t> wanted) {
  InputText file(path);
  const PartOfFile frame = find_dump_frame(file, path, wanted);
  Lines lines(file, path, frame.begin);
  lines.set_advice(advice_where_cut_short(frame.number));
  lines.advance(begin_of_frame);
  Configuration configuration;
  std::int64_t count = -1;
  Corner corner;
  while (!lines.line().starts_with(begin_of_atoms)) {
    if (!lines.line().starts_with("ITEM: ")) lines.reject("expected ITEM: and a name");
    if (lines.line().starts_with(begin_of_box)) {
      corner = read_box(lines, configuration);
    } else {
      const bool is_count = lines.line().starts_with("ITEM: NUMBER OF ATOMS");
      lines.advance("a number");
      if (lines.fields().size() != 1) lines.reject("expected a number");
      if (is_count) count = lines.row().read_whole(0, "number of atoms", 0, most_needles);
    }
    lines.advance(begin_of_atoms);
  }
  if (count < 0) lines.reject("no number of atoms: expected ITEM: NUMBER OF ATOMS before");
  if (configuration.state.box[0] == 0) {
    lines.reject(fmt::format("no box: expected {} before", begin_of_box));
  }
  Columns columns = read_columns(lines);
  columns.lower = corner.lower;
  columns.tilt = corner.tilt;
  NeedleReader needles(columns, configuration);
  needles.reserve(count, frame.bytes());
  const std::string expected = fmt::format("{} atoms", count);
  Gravity gravity;
  for (std::int64_t i = 0; i < count; ++i) {
    lines.advance(expected);
    lines.require_whole(columns.count, expected);
    needles.read(lines.row());
    if (!columns.force) continue;
    const auto mass = columns.bodies.mass;
    if (mass && is_infinite(lines.fields()[*mass])) continue;  // whatever acts on a fixed needle
    gravity.add(lines.row(), *columns.force, mass ? lines.row().read(*mass, "mass") : 1);
  }
  while (lines.advance_if_any()) {
    if (begins_next_frame(lines.line())) break;
    if (!lines.is_blank()) lines.reject(fmt::format("expected no line after {} atoms", count));
  }
  needles.finish(path);
  configuration.material.gravity =
      gravity.along_walls(configuration.state.periodic, configuration.notes);
  return configuration;
}

std::unique_ptr<FrameWriter> write_lammps_dump(const std::string& path, bool force,
                                               const Material& material) {
  return std::make_unique<DumpWriter>(path, force, material);
}

}  // namespace needlework::io
