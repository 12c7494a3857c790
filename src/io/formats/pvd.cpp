#include "src/io/formats/pvd.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "needlework/error.h"
#include "src/box/tilt.h"
#include "src/box/vector.h"
#include "src/io/formats/text_file.h"
#include "src/io/formats/vtu.h"
#include "src/io/needle_check.h"
#include "src/io/needle_ends.h"

namespace needlework::io {
namespace {

namespace fs = std::filesystem;
constexpr std::uint8_t vtk_line = 3;

std::vector<double> flat(const std::vector<Vector>& vectors) {
  std::vector<double> numbers;
  numbers.reserve(3 * vectors.size());
  for (const Vector& v : vectors) numbers.insert(numbers.end(), v.begin(), v.end());
  return numbers;
}

// Lines between pairs of points that follow each other.
void add_lines(VtuFile& file, const std::vector<Vector>& points) {
  std::vector<std::int64_t> connectivity, offsets;
  for (std::size_t i = 0; i < points.size(); ++i) {
    connectivity.push_back(static_cast<std::int64_t>(i));
    if (i % 2 == 1) offsets.push_back(static_cast<std::int64_t>(i + 1));
  }
  file.begin("Points");
  file.add("Points", flat(points), 3);
  file.begin("Cells");
  file.add("connectivity", connectivity);
  file.add("offsets", offsets);
  file.add("types", std::vector<std::uint8_t>(points.size() / 2, vtk_line));
}

// The twelve edges, from corner 0 to the box's far corner.
std::vector<Vector> outline(const TiltedCell& box) {
  const auto edges = box.vectors();
  const auto corner_of = [&](const std::array<int, 3>& times) {
    Vector out{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t n = 0; n < 3; ++n) out[axis] += times[n] * edges[n][axis];
    return out;
  };
  std::vector<Vector> points;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      std::array<int, 3> times{};
      times[(axis + 1) % 3] = corner % 2;
      times[(axis + 2) % 3] = corner / 2;
      points.push_back(corner_of(times));
      times[axis] = 1;
      points.push_back(corner_of(times));
    }
  }
  return points;
}

class PvdWriter : public FrameWriter {
 public:
  PvdWriter(const std::string& path, bool force, const Material& material);
  ~PvdWriter() override;

  void add(const Frame& frame) override;
  void publish() override;

 private:
  void write_needles(const std::string& name, const State& state);
  void write_box(const std::string& name, const State& state);
  // Where a file of the folder is, which is removed if nothing is published.
  std::string file_of(const std::string& name);
  void list(double time, int part, const std::string& name);

  std::vector<double> lengths_, diameters_;
  bool force_, wide_;
  TextFile collection_;
  fs::path folder_;
  bool made_folder_ = false;
  std::vector<std::string> new_files_;
  std::optional<std::pair<std::array<Vector, 3>, std::array<bool, 3>>> box_;  // of the last outline
  std::string box_name_;
};

PvdWriter::PvdWriter(const std::string& path, bool force, const Material& material)
    : lengths_(lengths_of(material)),
      diameters_(diameters_of(material)),
      force_(force),
      wide_(has_width(material)),
      collection_(path, force),
      folder_(path) {
  folder_.replace_extension();
  if (folder_ == fs::path(path)) folder_ += "-frames";
  if (fs::exists(folder_)) {
    if (!force || !fs::is_directory(folder_)) {
      throw IoError(fmt::format("{}: exists already: expected a new name, or force to replace it",
                                folder_.string()));
    }
  } else {
    std::error_code error;
    if (!fs::create_directory(folder_, error)) {
      throw IoError(fmt::format("{}: {}", folder_.string(), error.message()));
    }
    made_folder_ = true;
  }
  collection_.print(R"(<?xml version="1.0"?>
<VTKFile type="Collection" version="0.1">
  <Collection>
)");
}

PvdWriter::~PvdWriter() {
  std::error_code ignored;
  for (const std::string& file : new_files_) fs::remove(file, ignored);
  if (made_folder_) fs::remove(folder_, ignored);
}

std::string PvdWriter::file_of(const std::string& name) {
  std::string file = (folder_ / name).string();
  if (!fs::exists(file)) new_files_.push_back(file);
  return file;
}

void PvdWriter::list(double time, int part, const std::string& name) {
  std::string file;
  for (const char c : (folder_.filename() / name).string()) {
    switch (c) {
      case '&':
        file += "&amp;";
        break;
      case '<':
        file += "&lt;";
        break;
      case '"':
        file += "&quot;";
        break;
      case '\n':
      case '\r':
      case '\t':  // a reader would take these for blanks
        file += fmt::format("&#{};", static_cast<int>(c));
        break;
      default:
        file += c;
    }
  }
  collection_.print("    <DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", time, part, file);
}

void PvdWriter::add(const Frame& frame) {
  const double time = frame.time.value_or(static_cast<double>(frame.number));
  const std::string name = fmt::format("frame-{:05}.vtu", frame.number);
  write_needles(name, frame.state);
  if (const auto box = std::pair(TiltedCell(frame.state).vectors(), frame.state.periodic);
      box_ != box) {
    box_ = box;
    box_name_ = fmt::format("box-{:05}.vtu", frame.number);
    write_box(box_name_, frame.state);
  }
  list(time, 0, name);
  list(time, 1, box_name_);
}

void PvdWriter::write_needles(const std::string& name, const State& state) {
  VtuFile file(file_of(name), force_);
  add_lines(file, ends_of(state, lengths_));
  std::vector<std::int64_t> ids;
  std::vector<double> speeds, spins;
  std::vector<std::uint8_t> species;
  for (std::size_t i = 0; i < 2 * state.size(); ++i) {
    ids.push_back(id_of(state, i / 2));
    speeds.push_back(length_of(state.velocity[i / 2]));
    spins.push_back(length_of(state.angular_velocity[i / 2]));
    species.push_back(static_cast<std::uint8_t>(species_at(state, i / 2)));
  }
  file.begin("PointData");
  file.add("id", ids);
  file.add("speed", speeds, 1);
  file.add("spin", spins, 1);
  file.add("species", species);
  if (wide_) file.add("radius", radii_of_ends(state, diameters_), 1);
  const OwnBodies& own = state.own_bodies;
  for (const auto& [what, rows] : {std::pair("length", &own.length), {"mass", &own.mass}})
    if (!rows->empty()) file.add(what, at_both_ends(*rows), 1);
  file.begin("CellData");
  file.add("velocity", flat(state.velocity), 3);
  file.add("orientation", flat(state.orientation), 3);
  file.add("angular_velocity", flat(state.angular_velocity), 3);
  file.publish(2 * state.size(), state.size());
}

void PvdWriter::write_box(const std::string& name, const State& state) {
  const std::vector<Vector> points = outline(TiltedCell(state));
  VtuFile file(file_of(name), force_);
  if (state.periodic != std::array{true, true, true}) {
    const std::array<int, 3> periodic{state.periodic[0], state.periodic[1], state.periodic[2]};
    file.add_field("periodic", periodic);
  }
  add_lines(file, points);
  file.publish(points.size(), points.size() / 2);
}

void PvdWriter::publish() {
  collection_.print("  </Collection>\n</VTKFile>\n");
  collection_.publish();
  new_files_.clear();
  made_folder_ = false;
}

}  // namespace

std::unique_ptr<FrameWriter> write_pvd(const std::string& path, bool force,
                                       const Material& material) {
  return std::make_unique<PvdWriter>(path, force, material);
}

}  // namespace needlework::io
