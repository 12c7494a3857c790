// Reads states: the frames of a file, with a check of each number.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/box/tilt.h"
#include "src/box/vector.h"
#include "src/io/bodies.h"
#include "src/io/frame_rows.h"
#include "src/io/in_child_process.h"
#include "src/io/needle_check.h"
#include "src/io/source.h"
#include "src/machine/stop_request.h"

namespace needlework {

static void transfer(Archive& archive, Bodies& bodies) {
  auto& [names, length, diameter, mass, k, q, inertia] = bodies;
  archive(names, length, diameter, mass, k, q, inertia);
}

static void transfer(Archive& archive, OwnBodies& bodies) {
  archive(bodies.length, bodies.diameter, bodies.mass, bodies.inertia);
}

static void transfer(Archive& archive, State& state) {
  auto& [box, low, periodic, slide, shear_rate, scale, position, velocity, peculiar_velocity,
         peculiar_x, orientation, angular_velocity, image, id, species, bodies, own_bodies] = state;
  archive(box, low, periodic, slide, shear_rate, scale, position, velocity, peculiar_velocity,
          peculiar_x, orientation, angular_velocity, image, id, species, bodies, own_bodies);
}

}  // namespace needlework

namespace needlework::io {

using hdf5::Shape;

namespace {

[[noreturn]] void reject(const std::string& place, const std::string& what) {
  throw InputError(place + what);
}

// The part of an element that belongs to one frame: a row, or the whole of a plain dataset.
struct Slice {
  const Element* element;
  std::optional<hsize_t> frame;

  std::string index(std::size_t needle) const {
    return frame ? fmt::format("[{}][{}]", *frame, needle) : fmt::format("[{}]", needle);
  }
};

}  // namespace

class FrameReader {
 public:
  explicit FrameReader(const std::string& path);

  std::size_t count() const { return rows_->count(); }
  std::size_t needles() const { return needles_; }
  Bodies bodies() const { return read_bodies(source_); }
  std::optional<double> time(std::size_t frame) const;
  State read(std::size_t frame);

 private:
  std::string place(const Element& element) const { return source_.place(element.name()); }
  bool has(const std::string& name) const {
    const std::string path = group_ + "/" + name;
    return hdf5::exists(source_.get(), path, source_.place(path));
  }
  const Element& element(const std::string& name) {
    return elements_.try_emplace(name, source_, group_ + "/" + name).first->second;
  }
  Slice slice(const Element& element, std::size_t rank) const {
    return {&element, rows_->row(element, rank, frame_)};
  }

  std::array<bool, 3> read_periodic() const;
  Vector read_box(double& xy);
  Vector read_low();
  double read_scale();
  bool has_row_a_frame(const Element& edges) const;
  Vector diagonal(const Slice& edges, double& xy) const;
  double read_shear_rate() const;
  std::vector<Vector> read_vectors(const std::string& name);
  std::vector<std::array<std::int32_t, 3>> read_images();
  std::vector<double> read_numbers(const std::string& name, double largest, const char* expected);
  std::vector<std::uint32_t> read_ids();
  std::vector<std::uint8_t> read_species();
  void require_needles(const State& state);

  Source source_;
  std::string group_;
  std::map<std::string, Element> elements_;
  std::uint64_t needles_ = 0;
  std::optional<FrameRows> rows_;
  std::optional<std::vector<double>> times_;  // of the rows of the positions
  std::size_t frame_ = 0;                     // the one that is read
};

FrameReader::FrameReader(const std::string& path) : source_(path), group_(find_particles(source_)) {
  for (const char* name : {"position", "velocity", "orientation", "angular_velocity"})
    element(name);
  for (const char* name : {"image", "id", "species", "box/edges", "box/low", "box/scale"}) {
    if (has(name)) element(name);
  }
  if (!has("box/edges")) reject(source_.place(group_ + "/box/edges"), ": missing: expected edges");
  read_periodic();

  const Element& position = element("position");
  const Shape& shape = position.shape();
  if (shape.size() < 2) {
    reject(place(position),
           fmt::format(": shape {}: expected [frames][needles][3]", hdf5::to_string(shape)));
  }
  needles_ = shape[shape.size() - 2];
  if (needles_ > std::numeric_limits<std::uint32_t>::max()) {
    reject(place(position), fmt::format(": {} needles: expected fewer than 2^32", needles_));
  }
  std::vector<const Element*> all;
  for (const auto& [name, element] : elements_) all.push_back(&element);
  rows_.emplace(source_, position, all);
  if (position.is_group()) times_ = position.times();
}

std::optional<double> FrameReader::time(std::size_t frame) const {
  const auto row = rows_->row(elements_.at("position"), 2, frame);
  if (!times_ || !row || *row >= times_->size()) return {};
  return (*times_)[*row];
}

State FrameReader::read(std::size_t frame) {
  if (frame >= count()) {
    throw std::invalid_argument(
        fmt::format("{}: frame {}: expected one below {}", source_.path(), frame, count()));
  }
  frame_ = frame;
  State state;
  double xy = 0;
  state.box = read_box(xy);
  const Tilt tilt = reduced_tilt(xy, state.box[0]);
  state.slide = tilt.rest;
  if (has("box/low")) state.low = read_low();
  state.periodic = read_periodic();
  state.shear_rate = read_shear_rate();
  state.position = read_vectors("position");
  state.velocity = read_vectors("velocity");
  state.orientation = read_vectors("orientation");
  state.angular_velocity = read_vectors("angular_velocity");
  if (has("image")) state.image = read_images();
  for (auto& image : state.image) image = tilt.counted(image);
  if (has("id")) state.id = read_ids();
  if (has("species")) state.species = read_species();
  state.bodies = bodies();
  state.own_bodies = read_own_bodies(source_, needles_);
  // Files do not write it for thin needles.
  OwnBodies& own = state.own_bodies;
  const bool are_thin =
      std::ranges::all_of(state.bodies.diameter, [](double diameter) { return diameter == 0; });
  if (!own.empty() && own.diameter.empty() && are_thin) own.diameter.assign(needles_, 0);
  if (has("box/scale")) enlarge(state, read_scale());
  require_needles(state);
  return state;
}

// One word for each axis, or one for all.
std::array<bool, 3> FrameReader::read_periodic() const {
  std::array<bool, 3> periodic{true, true, true};
  const std::string path = group_ + "/box";
  const std::string where = source_.place(path);
  const hdf5::Handle box = hdf5::open_group(source_.get(), path, where);
  if (hdf5::check(H5Aexists(box.get(), "boundary"), where) == 0) return periodic;
  const auto words = hdf5::read_strings_attribute(box.get(), "boundary", where);
  if (words.size() != 1 && words.size() != 3) {
    reject(where, fmt::format(": boundary of {} words: expected one for each axis", words.size()));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& boundary = words[words.size() == 1 ? 0 : axis];
    if (boundary != "periodic" && boundary != "none") {
      reject(where, fmt::format(": boundary = {}: expected periodic or none", boundary));
    }
    periodic[axis] = boundary == "periodic";
  }
  return periodic;
}

// 0 for a file without one.
double FrameReader::read_shear_rate() const {
  const std::string path = group_ + "/box";
  const std::string where = source_.place(path);
  const hdf5::Handle box = hdf5::open_group(source_.get(), path, where);
  if (hdf5::check(H5Aexists(box.get(), "shear_rate"), where) == 0) return 0;
  const hdf5::Handle attribute(H5Aopen(box.get(), "shear_rate", H5P_DEFAULT), H5Aclose, where);
  const hdf5::Handle space(H5Aget_space(attribute.get()), H5Sclose, where);
  const auto numbers = H5Sget_simple_extent_npoints(space.get());
  if (numbers != 1) reject(where, fmt::format(": shear_rate of {} numbers: expected one", numbers));
  double rate = 0;
  hdf5::check(H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &rate), where);
  if (!std::isfinite(rate))
    reject(where, fmt::format(": shear_rate = {}: expected a finite number", rate));
  return rate;
}

Vector FrameReader::read_box(double& xy) {
  const Element& edges = element("box/edges");
  const Shape& shape = edges.shape();
  const std::size_t rank = shape.size();
  if (rank < 1 || rank > 3 || shape.back() != 3 || (rank == 3 && shape[1] != 3)) {
    reject(place(edges), fmt::format(": shape {}: expected [3], [3][3], [frames][3] or "
                                     "[frames][3][3]",
                                     hdf5::to_string(shape)));
  }
  Vector box{};
  if (rank == 1) {
    const auto values = edges.read<double>({});
    std::copy_n(values.begin(), 3, box.begin());
  } else if (rank == 3) {
    box = diagonal(slice(edges, 2), xy);
  } else {
    if (has_row_a_frame(edges)) {
      const auto values = edges.read<double>(*slice(edges, 1).frame);
      std::copy_n(values.begin(), 3, box.begin());
    } else {
      box = diagonal({&edges, {}}, xy);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(box[axis] > 0) || std::isinf(box[axis])) {
      reject(place(edges),
             fmt::format(", axis {} = {}: expected an edge above 0", axis, box[axis]));
    }
  }
  return box;
}

// Where the low edges are, of a file of this program.
Vector FrameReader::read_low() {
  const Element& low = element("box/low");
  const Shape& shape = low.shape();
  if (shape.size() != 2 || shape[1] != 3)
    reject(place(low), fmt::format(": shape {}: expected [frames][3]", hdf5::to_string(shape)));
  const auto values = low.read<double>(slice(low, 1).frame);
  Vector out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] = values[axis];
    if (!std::isfinite(out[axis]))
      reject(place(low), fmt::format(", axis {} = {}: expected a finite number", axis, out[axis]));
  }
  return out;
}

// The sizes of bodies that grow, of a file of this program.
double FrameReader::read_scale() {
  const Element& scale = element("box/scale");
  if (scale.shape().size() != 1)
    reject(place(scale),
           fmt::format(": shape {}: expected [frames]", hdf5::to_string(scale.shape())));
  const double value = scale.read<double>(slice(scale, 0).frame).front();
  if (!(value > 0) || std::isinf(value))
    reject(place(scale), fmt::format(" = {}: expected a finite number > 0", value));
  return value;
}

// Whether edges of shape [n][3] have one row for each frame. The shape [3][3] is read as a matrix
// unless it must be the edges of three frames.
bool FrameReader::has_row_a_frame(const Element& edges) const {
  if (edges.shape()[0] != 3 || edges.steps()) return true;
  const Element& position = elements_.at("position");
  if (position.shape().size() != 3 || position.rows() != 3) return false;
  const auto values = edges.read<double>({});
  const std::vector<double> first(values.begin(), values.begin() + 3);
  // Three equal rows are not a matrix, because the box would have no volume.
  return edges.is_group() || (std::equal(first.begin(), first.end(), values.begin() + 3) &&
                              std::equal(first.begin(), first.end(), values.begin() + 6));
}

// The edges of a box, of which the one along y may be tilted along x: `xy`.
Vector FrameReader::diagonal(const Slice& edges, double& xy) const {
  const auto matrix = edges.element->read<double>(edges.frame);
  Vector box{};
  for (std::size_t i = 0; i < 9; ++i) {
    if (i % 4 == 0) {
      box[i / 4] = matrix[i];
    } else if (i == 3) {
      if (!std::isfinite(matrix[i]))
        reject(place(*edges.element),
               fmt::format("{}[1] = {}: expected a finite number", edges.index(0), matrix[i]));
      xy = matrix[i];
    } else if (matrix[i] != 0) {
      reject(place(*edges.element), fmt::format("{}[{}] = {}: expected 0, a box that is "
                                                "rectangular or tilted along x by y",
                                                edges.index(i / 3), i % 3, matrix[i]));
    }
  }
  return box;
}

std::vector<Vector> FrameReader::read_vectors(const std::string& name) {
  StopRequest::check();
  const Element& source = element(name);
  const Shape& shape = source.shape();
  const bool timed = source.is_group() || shape.size() == 3;
  const Shape expected =
      timed ? Shape{shape.empty() ? 1 : shape[0], needles_, 3} : Shape{needles_, 3};
  if (shape != expected) {
    reject(place(source), fmt::format(": shape {}: expected {}", hdf5::to_string(shape),
                                      hdf5::to_string(expected)));
  }
  const Slice part = slice(source, 2);
  std::vector<Vector> vectors(needles_);
  source.read_as(H5T_NATIVE_DOUBLE, part.frame, vectors.data());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::isfinite(vectors[i][axis])) continue;
      reject(place(source), fmt::format("{}[{}] = {}: expected a finite number", part.index(i),
                                        axis, vectors[i][axis]));
    }
  }
  return vectors;
}

std::vector<std::array<std::int32_t, 3>> FrameReader::read_images() {
  const std::vector<Vector> values = read_vectors("image");
  std::vector<std::array<std::int32_t, 3>> images(values.size());
  const Slice part = slice(element("image"), 2);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = values[i][axis];
      if (value != std::trunc(value) ||
          std::abs(value) > std::numeric_limits<std::int32_t>::max()) {
        reject(place(element("image")),
               fmt::format("{}[{}] = {}: expected a whole number of 32 bits", part.index(i), axis,
                           value));
      }
      images[i][axis] = static_cast<std::int32_t>(value);
    }
  }
  return images;
}

// One whole number for each needle.
std::vector<double> FrameReader::read_numbers(const std::string& name, double largest,
                                              const char* expected) {
  const Element& source = element(name);
  const Shape& shape = source.shape();
  if ((shape.size() != 1 && shape.size() != 2) || shape.back() != needles_) {
    reject(place(source), fmt::format(": shape {}: expected [{}] or [frames][{}]",
                                      hdf5::to_string(shape), needles_, needles_));
  }
  const Slice part = slice(source, 1);
  const auto values = source.read<double>(part.frame);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= 0 && values[i] <= largest && values[i] == std::trunc(values[i])) continue;
    reject(place(source), fmt::format("{} = {}: expected {}", part.index(i), values[i], expected));
  }
  return values;
}

std::vector<std::uint8_t> FrameReader::read_species() {
  const auto values = read_numbers("species", most_species - 1, "a whole number from 0 to 254");
  return {values.begin(), values.end()};
}

std::vector<std::uint32_t> FrameReader::read_ids() {
  const Element& source = element("id");
  const auto values = read_numbers("id", std::numeric_limits<std::uint32_t>::max(),
                                   "a whole number from 0 to 2^32 - 1");
  const Slice part = slice(source, 1);
  const std::vector<std::uint32_t> ids(values.begin(), values.end());
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  const auto twice = std::adjacent_find(order.begin(), order.end(),
                                        [&](std::size_t a, auto b) { return ids[a] == ids[b]; });
  if (twice != order.end()) {
    reject(place(source), fmt::format("{} = {}: expected an id other than that of entry {}",
                                      part.index(twice[1]), ids[twice[1]], twice[0]));
  }
  return ids;
}

// Whether it may be a sphere, whose director marks nothing: the file says so, or leaves that to the
// scene (adopt_state()).
static bool may_be_sphere(const State& state, std::size_t i) {
  if (!state.own_bodies.length.empty()) return state.own_bodies.length[i] == 0;
  const std::size_t species = state.species.empty() ? 0 : state.species[i];
  const std::vector<double>& known = state.bodies.length;
  return known.empty() || (species < known.size() && known[species] == 0);
}

void FrameReader::require_needles(const State& state) {
  const auto show = [&](const char* name, std::size_t i, const Vector& v) {
    const Element& source = element(name);
    return fmt::format("{}{} = ({}, {}, {})", place(source), slice(source, 2).index(i), v[0], v[1],
                       v[2]);
  };
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vector& u = state.orientation[i];
    const Vector& w = state.angular_velocity[i];
    if (!is_unit(u)) {
      reject(show("orientation", i, u),
             fmt::format(", of length {}: expected a unit vector, within {}", length_of(u),
                         director_tolerance));
    }
    if (may_be_sphere(state, i)) continue;
    if (const double part = part_along(w, u); !(std::abs(part) <= director_tolerance)) {
      reject(show("angular_velocity", i, w),
             fmt::format(", of which {} of its length along the director: expected none, within {}",
                         part, director_tolerance));
    }
  }
}

struct FrameFile::Implementation {
  explicit Implementation(const std::string& path)
      : reader(path, [&] { return std::make_unique<FrameReader>(path); }) {}

  InChildProcess<FrameReader> reader;
  std::size_t count = reader.call<&FrameReader::count>();
  std::size_t needles = reader.call<&FrameReader::needles>();
};

FrameFile::FrameFile(const std::string& path)
    : implementation_(std::make_unique<Implementation>(path)) {}

FrameFile::~FrameFile() = default;

std::size_t FrameFile::count() const { return implementation_->count; }
std::size_t FrameFile::needles() const { return implementation_->needles; }

Bodies FrameFile::bodies() const { return implementation_->reader.call<&FrameReader::bodies>(); }

std::optional<double> FrameFile::time(std::size_t frame) const {
  return implementation_->reader.call<&FrameReader::time>(frame);
}

State FrameFile::read(std::size_t frame) const {
  return implementation_->reader.call<&FrameReader::read>(frame);
}

State read_last_frame(const std::string& path) {
  const FrameFile file(path);
  return file.read(file.count() - 1);
}

}  // namespace needlework::io
