#include "src/io/formats/xyz.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "needlework/error.h"
#include "src/box/tilt.h"
#include "src/io/decimal.h"
#include "src/io/formats/columns.h"
#include "src/io/formats/input_text.h"
#include "src/io/formats/rod.h"
#include "src/io/formats/text_file.h"

namespace needlework::io {
namespace {

constexpr ColumnNames xyz_names{
    "pos:R:3", "velo:R:3, velocities:R:3, or momenta:R:3 and masses:R:1",
    "director:R:3, orientation:R:3 or, a quaternion, orientation:R:4", "angular_velocity:R:3"};

std::string_view unquoted(std::string_view text) {
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
      text.front() == text.back()) {
    return text.substr(1, text.size() - 2);
  }
  return text;
}

// Sets the edges, and returns the tilt xy.
double read_lattice(std::string_view text, const Lines& lines, State& state) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() != 9) {
    lines.reject(fmt::format("Lattice of {} numbers: expected 9", words.size()));
  }
  std::array<double, 9> values{};
  for (std::size_t i = 0; i < 9; ++i) {
    const bool edge = i % 4 == 0, tilt = i == 3 || i > 5;  // xy, xz and yz
    double& value = values[i];
    if (read_decimal(words[i], value) != std::errc() ||
        (edge ? !(value > 0) : !tilt && value != 0)) {
      lines.reject(fmt::format("Lattice with {} in row {}, column {}: expected {}", words[i], i / 3,
                               i % 3,
                               edge   ? "an edge > 0"
                               : tilt ? "a finite number"
                                      : "0: a rectangular box, or one that is tilted along x"));
    }
    if (edge) state.box[i / 4] = value;
  }
  require_no_other_tilt(values[6], values[7], lines.row());
  return values[3];
}

// One letter for each axis: T, or F where the box is not periodic.
std::array<bool, 3> read_pbc(std::string_view text, const Lines& lines) {
  const std::vector<std::string_view> words = words_of(text);
  std::array<bool, 3> periodic{};
  bool good = words.size() == 3;
  for (std::size_t axis = 0; good && axis < 3; ++axis) {
    const std::string_view word = words[axis];
    periodic[axis] = word == "T" || word == "t" || word == "1" || word == "True" || word == "true";
    good = periodic[axis] || word == "F" || word == "f" || word == "0" || word == "False" ||
           word == "false";
  }
  if (!good) lines.reject(fmt::format("pbc = {}: expected T or F for each axis", text));
  return periodic;
}

// "name:type:columns:name:type:columns..."
Columns read_properties(std::string_view text, const Lines& lines) {
  Columns columns;
  std::set<std::string_view> found;
  while (!text.empty()) {
    std::string_view parts[3];
    for (std::string_view& part : parts) {
      const std::size_t end = std::min(text.find(':'), text.size());
      part = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    const auto [name, type, width] = parts;
    const bool known_type = type == "S" || type == "R" || type == "I" || type == "L";
    if (!known_type || width.size() != 1 || width[0] < '1' || width[0] > '9') {
      lines.reject(
          fmt::format("Properties with {}:{}:{}: expected NAME:TYPE:COLUMNS", name, type, width));
    }
    if (!found.insert(name).second) {
      lines.reject(fmt::format("Properties with {} twice: expected different names", name));
    }
    const std::size_t first = columns.count;
    columns.count += static_cast<std::size_t>(width[0] - '0');
    const VectorColumns vector{first, first + 1, first + 2};
    const bool is_vector = type == "R" && width == "3";
    if (name == "id" && type == "I" && width == "1") columns.id = first;
    if (name == "needle_species" && type == "I" && width == "1") columns.species = first;
    if (type == "R" && width == "1") {
      if (name == "length") columns.bodies.length = first;
      if (name == "diameter") columns.bodies.diameter = first;
      if (name == "masses") columns.bodies.mass = first;
      if (name == "inertia") columns.bodies.inertia = first;
    }
    // Its scalar is the last of the four.
    if (name == "orientation" && type == "R" && width == "4")
      columns.quaternion = {first + 3, first, first + 1, first + 2};
    if (!is_vector) continue;
    if (name == "pos") columns.position = vector;
    if (name == "velo" || name == "velocities") columns.velocity = vector;
    if (name == "director") columns.orientation = vector;
    if (name == "orientation" && !found.contains("director")) columns.orientation = vector;
    if (name == "angular_velocity") columns.angular_velocity = vector;
    if (name == "momenta") columns.momentum = vector;
  }
  return columns;
}

Columns read_comment(const Lines& lines, Configuration& configuration) {
  std::string_view lattice, properties;
  std::set<std::string_view> keys;
  for (const std::string_view word : words_of(lines.line())) {
    const std::size_t equals = word.find('=');
    if (equals == word.npos) continue;
    const std::string_view key = unquoted(word.substr(0, equals));
    if (!keys.insert(key).second) {
      lines.reject(fmt::format("{} twice: expected each key once", quotation(key)));
    }
    const std::string_view value = unquoted(word.substr(equals + 1));
    if (key == "Lattice") lattice = value;
    if (key == "Properties") properties = value;
    if (key == "pbc") configuration.state.periodic = read_pbc(value, lines);
    set_material(configuration.material, key, value, lines.row());
    set_flow(configuration.state, key, value, lines.row());
  }
  if (lattice.empty()) lines.reject("Lattice is missing: expected a box");
  if (properties.empty()) lines.reject("Properties is missing: expected the names of the columns");
  const double tilt = read_lattice(lattice, lines, configuration.state);
  Columns columns = read_properties(properties, lines);
  columns.tilt = tilt;
  require_all_vectors(columns, xyz_names, lines.row());
  return columns;
}

std::int64_t read_count(const Lines& lines) {
  if (lines.fields().size() != 1) {
    lines.reject(fmt::format("{} words: expected the number of needles", lines.fields().size()));
  }
  return lines.row().read_whole(0, "number of needles", 0, most_needles);
}

// The last one if none is asked for.
PartOfFile find_xyz_frame(InputText& file, const std::string& path,
                          std::optional<std::size_t> wanted) {
  Lines lines(file, path);
  PartOfFile last;
  std::size_t frames = 0;
  bool more = lines.advance_to_text();
  while (more) {
    if (lines.is_blank()) {  // blank lines may end the file
      if (lines.advance_to_text()) lines.reject("expected no line after a blank one");
      break;
    }
    last.begin = lines.place();
    last.number = frames++;
    lines.set_advice(advice_where_cut_short(last.number));
    const std::int64_t count = read_count(lines);
    const std::string expected = fmt::format("the comment and {} needles", count);
    for (std::int64_t i = 0; i <= count; ++i) lines.pass(expected);
    last.end = lines.next_place().offset;
    if (wanted == last.number) return last;
    more = lines.advance_if_any();
  }
  if (wanted) refuse_frame(path, *wanted, frames);
  return last;
}

class XyzWriter : public FrameWriter {
 public:
  XyzWriter(const std::string& path, bool force, const Material& material)
      : material_(material),
        all_(species_of(material)),
        wide_(has_width(material)),
        are_spheres_(are_spheres(material)),
        file_(path, force) {
    for (std::size_t n = 0; n < all_.size(); ++n) {
      const BodyOfRow body{all_[n].length, all_[n].diameter, 0, 0, 0};
      endings_.push_back(ending_of(body, n, false));
    }
  }

  void add(const Frame& frame) override {
    const State& state = frame.state;
    const TiltedCell cell(state);
    const bool are_own = !state.own_bodies.empty();
    const std::string of_species = text_of(grown(material_, state));
    const auto [a, b, c] = cell.vectors();
    file_.print(
        "{}\nLattice=\"{} {} {}\" Properties=species:S:1:pos:R:3:id:I:1:velo:R:3:"
        "director:R:3:angular_velocity:R:3:orientation:R:4:aspherical_shape:R:3{}{}{}",
        state.size(), fmt::join(a, " "), fmt::join(b, " "), fmt::join(c, " "),
        all_.size() > 1 ? ":needle_species:I:1" : "",
        are_own ? ":length:R:1:masses:R:1:inertia:R:1" : "",
        are_own && wide_ ? ":diameter:R:1" : "");
    if (frame.time) file_.print(" Time={}", *frame.time);
    file_.print("{}", text_of_flow(state));
    const auto letter = [&](std::size_t axis) { return state.periodic[axis] ? 'T' : 'F'; };
    file_.print(" pbc=\"{} {} {}\"{}{}\n", letter(0), letter(1), letter(2),
                of_species.empty() ? "" : " ", of_species);
    for (std::size_t i = 0; i < state.size(); ++i) {
      const auto r = cell.position(i);
      const auto& v = state.velocity[i];
      const auto& u = state.orientation[i];
      const auto& w = state.angular_velocity[i];
      const auto q = quaternion_of(u);
      const std::size_t species = species_at(state, i);
      file_.print(
          "X {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}{}\n", r[0], r[1], r[2],
          id_of(state, i), v[0], v[1], v[2], u[0], u[1], u[2], w[0], w[1], w[2], q[1], q[2], q[3],
          q[0], are_own ? ending_of(body_at(all_, state, i), species, true) : endings_.at(species));
    }
  }
  void publish() override { file_.publish(); }

 private:
  // Of the line of a needle.
  std::string ending_of(const BodyOfRow& body, std::size_t species, bool is_own) const {
    std::string out =
        fmt::format(" {}", fmt::join(drawn_shape(body.length, body.diameter, are_spheres_), " "));
    if (all_.size() > 1) out += fmt::format(" {}", species);
    if (is_own) out += fmt::format(" {} {} {}", body.length, body.mass, body.inertia);
    if (is_own && wide_) out += fmt::format(" {}", body.diameter);
    return out;
  }

  Material material_;
  std::vector<Species> all_;
  bool wide_, are_spheres_;
  std::vector<std::string> endings_;  // of a line, for each species of equal bodies
  TextFile file_;
};

}  // namespace

bool is_xyz(std::string_view beginning) {
  Lines lines(beginning, "");
  if (!lines.advance_to_text() || lines.fields().size() != 1) return false;
  const std::string_view count = lines.fields()[0];
  return std::all_of(count.begin(), count.end(), [](char c) { return c >= '0' && c <= '9'; });
}

Configuration read_xyz(const std::string& path, std::optional<std::size_t> wanted) {
  InputText file(path);
  const PartOfFile frame = find_xyz_frame(file, path, wanted);
  Lines lines(file, path, frame.begin);
  lines.set_advice(advice_where_cut_short(frame.number));
  lines.advance("the number of needles");
  const std::int64_t count = read_count(lines);
  lines.advance("a comment");
  Configuration configuration;
  const Columns columns = read_comment(lines, configuration);
  NeedleReader needles(columns, configuration);
  needles.reserve(count, frame.bytes());
  const std::string expected = fmt::format("{} needles", count);
  for (std::int64_t i = 0; i < count; ++i) {
    lines.advance(expected);
    lines.require_whole(columns.count, expected);
    needles.read(lines.row());
  }
  needles.finish(path);
  return configuration;
}

std::unique_ptr<FrameWriter> write_xyz(const std::string& path, bool force,
                                       const Material& material) {
  return std::make_unique<XyzWriter>(path, force, material);
}

}  // namespace needlework::io
