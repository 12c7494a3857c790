// Reads initial states: the last frame of a file, with a check of each number.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/source.h"

namespace needlework::io {

using hdf5::Shape;

namespace {

using Vector = std::array<double, 3>;

constexpr double director_tolerance = 1e-6;

double length(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

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

class FrameReader {
 public:
  explicit FrameReader(const std::string& path) : source_(path), group_(find_particles(source_)) {}

  State read();

 private:
  std::string place(const Element& element) const { return source_.place(element.name()); }
  bool has(const std::string& name) const {
    const std::string path = group_ + "/" + name;
    return hdf5::exists(source_.get(), path, source_.place(path));
  }
  const Element& element(const std::string& name) {
    return elements_.try_emplace(name, source_, group_ + "/" + name).first->second;
  }

  void require_periodic_box() const;
  void choose_frame();
  Slice slice(const Element& element, std::size_t rank) const;
  Vector read_box();
  bool has_row_a_frame(const Element& edges) const;
  Vector diagonal(const Slice& edges) const;
  std::vector<Vector> read_vectors(const std::string& name);
  std::vector<std::array<std::int32_t, 3>> read_images();
  std::vector<std::uint32_t> read_ids();
  void require_needles(const State& state);

  Source source_;
  std::string group_;
  std::map<std::string, Element> elements_;
  std::uint64_t needles_ = 0;
  std::optional<std::int64_t> step_;  // the step to read, if any element has steps
};

State FrameReader::read() {
  for (const char* name : {"position", "velocity", "orientation", "angular_velocity"})
    element(name);
  for (const char* name : {"image", "id", "box/edges"}) {
    if (has(name)) element(name);
  }
  if (!has("box/edges")) reject(source_.place(group_ + "/box/edges"), ": missing: expected edges");
  require_periodic_box();

  const Shape& shape = element("position").shape();
  if (shape.size() < 2) {
    reject(place(element("position")),
           fmt::format(": shape {}: expected [frames][needles][3]", hdf5::to_string(shape)));
  }
  needles_ = shape[shape.size() - 2];
  if (needles_ > std::numeric_limits<std::uint32_t>::max()) {
    reject(place(element("position")),
           fmt::format(": {} needles: expected fewer than 2^32", needles_));
  }
  choose_frame();

  State state;
  state.box = read_box();
  state.position = read_vectors("position");
  state.velocity = read_vectors("velocity");
  state.orientation = read_vectors("orientation");
  state.angular_velocity = read_vectors("angular_velocity");
  if (has("image")) state.image = read_images();
  if (has("id")) state.id = read_ids();
  require_needles(state);
  return state;
}

// H5MD gives the edges no meaning where a boundary is "none".
void FrameReader::require_periodic_box() const {
  const std::string path = group_ + "/box";
  const std::string where = source_.place(path);
  const hdf5::Handle box = hdf5::open_group(source_.get(), path, where);
  if (hdf5::check(H5Aexists(box.get(), "boundary"), where) == 0) return;
  for (const std::string& boundary : hdf5::read_strings_attribute(box.get(), "boundary", where)) {
    if (boundary != "periodic") {
      reject(where, fmt::format(": boundary = {}: expected periodic", boundary));
    }
  }
}

// Chooses the step to read: the last one that all elements with steps have. In the files of most
// programs that is the last step of each element. If a step occurs more than once, the last row
// with that step is read.
void FrameReader::choose_frame() {
  std::vector<std::pair<const Element*, std::size_t>> rows;
  for (const auto& [name, element] : elements_) {
    if (!element.steps()) continue;
    if (element.rows() == 0) reject(place(element), ": no frames: expected at least one");
    rows.emplace_back(&element, element.rows());
  }
  const auto last = [](const auto& row) { return (*row.first->steps())[row.second - 1]; };
  while (!rows.empty() && !step_) {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (const auto& row : rows) least = std::min(least, last(row));
    bool common = true;
    for (auto& row : rows) {
      while (row.second > 0 && last(row) > least) --row.second;
      if (row.second == 0) {
        reject(place(*row.first), ": no step in common with the other elements: expected one");
      }
      common = common && last(row) == least;
    }
    if (common) step_ = least;
  }
}

// The part of `element` to read if a frame has `rank` dimensions. An element without steps is read
// at the row of the positions.
Slice FrameReader::slice(const Element& element, std::size_t rank) const {
  if (element.shape().size() == rank) return {&element, {}};
  if (element.rows() == 0) reject(place(element), ": no frames: expected at least one");
  if (element.steps()) {
    const auto end = std::upper_bound(element.steps()->begin(), element.steps()->end(), *step_);
    return {&element, static_cast<hsize_t>(end - element.steps()->begin()) - 1};
  }
  const Element& position = elements_.at("position");
  if (&element == &position || position.shape().size() == 2) return {&element, element.rows() - 1};
  if (element.rows() != position.rows()) {
    reject(place(element), fmt::format(": {} frames: expected {}, as in {}", element.rows(),
                                       position.rows(), position.name()));
  }
  return {&element, slice(position, 2).frame};
}

Vector FrameReader::read_box() {
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
    box = diagonal(slice(edges, 2));
  } else {
    if (has_row_a_frame(edges)) {
      const auto values = edges.read<double>(*slice(edges, 1).frame);
      std::copy_n(values.begin(), 3, box.begin());
    } else {
      box = diagonal({&edges, {}});
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

Vector FrameReader::diagonal(const Slice& edges) const {
  const auto matrix = edges.element->read<double>(edges.frame);
  Vector box{};
  for (std::size_t i = 0; i < 9; ++i) {
    if (i % 4 == 0) {
      box[i / 4] = matrix[i];
    } else if (matrix[i] != 0) {
      reject(place(*edges.element), fmt::format("{}[{}] = {}: expected 0, a rectangular box",
                                                edges.index(i / 3), i % 3, matrix[i]));
    }
  }
  return box;
}

std::vector<Vector> FrameReader::read_vectors(const std::string& name) {
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

std::vector<std::uint32_t> FrameReader::read_ids() {
  const Element& source = element("id");
  const Shape& shape = source.shape();
  if ((shape.size() != 1 && shape.size() != 2) || shape.back() != needles_) {
    reject(place(source), fmt::format(": shape {}: expected [{}] or [frames][{}]",
                                      hdf5::to_string(shape), needles_, needles_));
  }
  const Slice part = slice(source, 1);
  const auto values = source.read<double>(part.frame);
  std::vector<std::uint32_t> ids(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= 0 && values[i] <= std::numeric_limits<std::uint32_t>::max()) ||
        values[i] != std::trunc(values[i])) {
      reject(place(source), fmt::format("{} = {}: expected a whole number from 0 to 2^32 - 1",
                                        part.index(i), values[i]));
    }
    ids[i] = static_cast<std::uint32_t>(values[i]);
  }
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

void FrameReader::require_needles(const State& state) {
  const auto show = [&](const char* name, std::size_t i, const Vector& v) {
    const Element& source = element(name);
    return fmt::format("{}{} = ({}, {}, {})", place(source), slice(source, 2).index(i), v[0], v[1],
                       v[2]);
  };
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vector& u = state.orientation[i];
    const Vector& w = state.angular_velocity[i];
    if (!(std::abs(length(u) - 1) <= director_tolerance)) {
      reject(show("orientation", i, u),
             fmt::format(", of length {}: expected a unit vector, within {}", length(u),
                         director_tolerance));
    }
    // The division prevents overflow and underflow in the length of the vector.
    const double scale = std::max({std::abs(w[0]), std::abs(w[1]), std::abs(w[2])});
    if (scale == 0) continue;
    const Vector direction{w[0] / scale, w[1] / scale, w[2] / scale};
    const double cosine = dot(direction, u) / length(direction);
    if (!(std::abs(cosine) <= director_tolerance)) {
      reject(show("angular_velocity", i, w),
             fmt::format(", of which {} of its length along the director: expected none, within {}",
                         cosine, director_tolerance));
    }
  }
}

}  // namespace

State read_last_frame(const std::string& path) {
  const hdf5::Session session;
  return FrameReader(path).read();
}

}  // namespace needlework::io
