#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "src/io/formats/columns.h"
#include "src/io/formats/input_text.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/text_file.h"

namespace needlework::io {
namespace {

constexpr std::string_view begin_of_frame = "ITEM: TIMESTEP";
constexpr std::string_view begin_of_box = "ITEM: BOX BOUNDS";
constexpr std::string_view begin_of_atoms = "ITEM: ATOMS";

void read_box(Lines& lines, State& state) {
  const auto words = lines.fields();
  if (words.size() != 6 || !std::all_of(words.begin() + 3, words.end(),
                                        [](std::string_view word) { return word == "pp"; })) {
    lines.reject(fmt::format("{}: expected {} pp pp pp, a rectangular periodic box",
                             lines.line().substr(0, 60), begin_of_box));
  }
  for (double& edge : state.box) {
    lines.advance("the bounds of the box");
    if (lines.fields().size() != 2) lines.reject("expected the two bounds of the box");
    edge = lines.row().read(1, "upper bound") - lines.row().read(0, "lower bound");
    if (!(edge > 0)) lines.reject(fmt::format("an edge of {}: expected one > 0", edge));
  }
}

Columns read_columns(const Lines& lines) {
  const auto& words = lines.fields();  // "ITEM:" "ATOMS" and the names
  Columns columns;
  columns.first_id = 1;
  columns.count = words.size() - 2;
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
  columns.image = find_vector("ix", "iy", "iz");
  columns.velocity = find_vector("vx", "vy", "vz");
  columns.orientation = find_vector("mux", "muy", "muz");
  columns.angular_velocity = find_vector("omegax", "omegay", "omegaz");
  columns.length = find("diameter");
  columns.mass = find("mass");
  require_all_vectors(columns, lines.row());
  return columns;
}

PartOfFile find_last_frame(InputText& file, const std::string& path) {
  Lines lines(file, path);
  PartOfFile last;
  bool found = false;
  while (lines.pass_if_any()) {
    if (!lines.line().starts_with(begin_of_frame)) continue;
    last.begin = lines.place();
    found = true;
  }
  if (!found) last.begin = lines.next_place();
  last.end = lines.next_place().offset;
  return last;
}

class DumpWriter : public FrameWriter {
 public:
  DumpWriter(const std::string& path, bool force, const Material& material)
      : length_(material.length), mass_(material.mass), file_(path, force) {}

  void add(const Frame& frame) override {
    const State& state = frame.state;
    file_.print("{}\n{}\nITEM: NUMBER OF ATOMS\n{}\n{} pp pp pp\n0 {}\n0 {}\n0 {}\n",
                begin_of_frame, frame.number, state.size(), begin_of_box, state.box[0],
                state.box[1], state.box[2]);
    file_.print("{} id type x y z ix iy iz vx vy vz mux muy muz omegax omegay omegaz{}{}\n",
                begin_of_atoms, length_ ? " diameter" : "", mass_ ? " mass" : "");
    std::string common;
    if (length_) common += fmt::format(" {}", *length_);
    if (mass_) common += fmt::format(" {}", *mass_);
    for (std::size_t i = 0; i < state.size(); ++i) {
      const auto& r = state.position[i];
      const auto& v = state.velocity[i];
      const auto& u = state.orientation[i];
      const auto& w = state.angular_velocity[i];
      const auto image = state.image.empty() ? std::array<std::int32_t, 3>{} : state.image[i];
      file_.print("{} 1 {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}{}\n",
                  std::int64_t{id_of(state, i)} + 1, r[0], r[1], r[2], image[0], image[1], image[2],
                  v[0], v[1], v[2], u[0], u[1], u[2], w[0], w[1], w[2], common);
    }
  }
  void publish() override { file_.publish(); }

 private:
  std::optional<double> length_, mass_;
  TextFile file_;
};

}  // namespace

bool is_lammps_dump(std::string_view beginning) { return beginning.starts_with("ITEM: "); }

Configuration read_lammps_dump(const std::string& path) {
  InputText file(path);
  const PartOfFile frame = find_last_frame(file, path);
  Lines lines(file, path, frame.begin);
  lines.advance(begin_of_frame);
  Configuration configuration;
  std::int64_t count = -1;
  while (!lines.line().starts_with(begin_of_atoms)) {
    if (!lines.line().starts_with("ITEM: ")) lines.reject("expected ITEM: and a name");
    if (lines.line().starts_with(begin_of_box)) {
      read_box(lines, configuration.state);
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
  const Columns columns = read_columns(lines);
  reserve_needles(configuration.state, columns, count, frame.bytes());
  const std::string expected = fmt::format("{} atoms", count);
  for (std::int64_t i = 0; i < count; ++i) {
    lines.advance(expected);
    read_needle(lines.row(), columns, configuration);
  }
  while (lines.advance_if_any()) {
    if (!lines.is_blank()) lines.reject(fmt::format("expected no line after {} atoms", count));
  }
  require_distinct_ids(configuration.state, columns.first_id, path);
  return configuration;
}

std::unique_ptr<FrameWriter> write_lammps_dump(const std::string& path, bool force,
                                               const Material& material) {
  return std::make_unique<DumpWriter>(path, force, material);
}

}  // namespace needlework::io
