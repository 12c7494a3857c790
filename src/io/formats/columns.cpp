#include "src/io/formats/columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "needlework/error.h"
#include "src/box/box.h"
#include "src/box/vector.h"
#include "src/io/decimal.h"
#include "src/io/needle_check.h"

namespace needlework::io {
namespace {

constexpr std::int64_t most_images = std::numeric_limits<std::int32_t>::max();

Vector read_vector(const Row& row, const VectorColumns& columns, const char* name) {
  Vector vector;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    vector[axis] = row.read(columns[axis], fmt::format("{} {}", name, "xyz"[axis]));
  }
  return vector;
}

// How many decimals three numbers have that are written with a fixed number of them; 0 for others.
std::size_t common_decimals(const Row& row, const VectorColumns& columns) {
  std::size_t common = 0;
  for (const std::size_t column : columns) {
    const std::string_view text = row.fields[column];
    const std::size_t point = text.find('.');
    if (point == text.npos || text.find_first_of("eE") != text.npos) return 0;
    const std::size_t decimals = text.size() - point - 1;
    if (common != 0 && decimals != common) return 0;
    common = decimals;
  }
  return common;
}

// How much of a vector along u the rounding of its components to so many decimals explains. Numbers
// with an exponent have as many digits as others, so that their rounding is small beside them.
double rounding_along(const Row& row, const VectorColumns& columns, const Vector& u) {
  const std::size_t decimals = common_decimals(row, columns);
  if (decimals == 0) return 0;
  const double half = 0.5 * std::pow(0.1, static_cast<double>(decimals));
  return 1.01 * half * (std::abs(u[0]) + std::abs(u[1]) + std::abs(u[2]));
}

std::pair<const char*, std::vector<double> Material::*> const materials[] = {
    {"length", &Material::length},     {"mass", &Material::mass},      {"k", &Material::k},
    {"epsilon", &Material::epsilon},   {"beta", &Material::beta},      {"meet", &Material::meet},
    {"diameter", &Material::diameter}, {"inertia", &Material::inertia}};

}  // namespace

void require_all_vectors(const Columns& columns, const ColumnNames& names, const Row& head) {
  std::vector<std::string> missing;
  for (const auto& [name, known, expected] :
       {std::tuple("position", columns.position.has_value(), names.position),
        std::tuple("velocity", columns.velocity || columns.momentum, names.velocity),
        std::tuple("orientation", columns.orientation || columns.quaternion, names.orientation),
        std::tuple("angular velocity", columns.angular_velocity || columns.angular_momentum,
                   names.angular_velocity)}) {
    if (!known) missing.push_back(fmt::format("no {}: expected the columns {}", name, expected));
  }
  if (!missing.empty()) head.reject(fmt::format("{}", fmt::join(missing, "; ")));
}

NeedleReader::NeedleReader(const Columns& columns, Configuration& configuration)
    : columns_(columns),
      bodies_(columns.bodies),
      configuration_(configuration),
      tilt_(reduced_tilt(columns.tilt, configuration.state.box[0])) {
  configuration.state.slide = tilt_.rest;
}

void NeedleReader::reserve(std::int64_t count, std::size_t bytes) {
  // A digit and a blank, or the end of the line, for each column.
  const std::size_t n = std::min(static_cast<std::size_t>(count), bytes / (2 * columns_.count) + 1);
  State& state = configuration_.state;
  state.position.reserve(n);
  state.velocity.reserve(n);
  state.orientation.reserve(n);
  state.angular_velocity.reserve(n);
  if (columns_.image || columns_.unwrapped) state.image.reserve(n);
  if (columns_.id) state.id.reserve(n);
}

void NeedleReader::read(const Row& row) {
  if (row.fields.size() != columns_.count) {
    row.reject(fmt::format("{} columns: expected {}", row.fields.size(), columns_.count));
  }
  State& state = configuration_.state;
  if (columns_.edges) take_edges(row);
  read_position(row);
  state.velocity.push_back(columns_.velocity ? read_vector(row, *columns_.velocity, "velocity")
                                             : read_vector(row, *columns_.momentum, "momentum"));
  if (columns_.id) {
    const std::int64_t most = std::numeric_limits<std::uint32_t>::max();
    state.id.push_back(static_cast<std::uint32_t>(
        row.read_whole(*columns_.id, "id", columns_.first_id, most) - columns_.first_id));
  }
  std::size_t species = 0;
  if (columns_.species) {
    const std::int64_t first = columns_.first_species;
    species = static_cast<std::size_t>(
        row.read_whole(*columns_.species, "species", first,
                       first + static_cast<std::int64_t>(most_species) - 1) -
        first);
    state.species.push_back(static_cast<SpeciesIndex>(species));
  }
  bodies_.read(row, species);
  read_rotation(row, species);
}

// Positions then count from the walls.
void NeedleReader::take_edges(const Row& row) {
  State& state = configuration_.state;
  const Vector edges = read_vector(row, *columns_.edges, "edges");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_tilted = axis == 0 && columns_.tilt != 0;
    if (state.periodic[axis] && !is_tilted) continue;
    if (!(edges[axis] > 0) || (!state.position.empty() && edges[axis] != state.box[axis])) {
      row.reject(fmt::format("edge {} = {}: expected a number > 0, the same in all rows",
                             "xyz"[axis], edges[axis]));
    }
    state.box[axis] = edges[axis];
    columns_.lower[axis] = 0;
  }
}

void NeedleReader::read_position(const Row& row) {
  State& state = configuration_.state;
  const Vector read = read_vector(row, *columns_.position, "position");
  Vector r = read;
  Shift image{};
  if (columns_.unwrapped) {
    // Scaled positions are in a box with edges of 1, from 0 on.
    const Box box = columns_.scaled ? Box({1, 1, 1}, state.periodic) : box_of(state);
    Vector from_corner = r;
    if (!columns_.scaled)
      for (std::size_t axis = 0; axis < 3; ++axis) from_corner[axis] -= columns_.lower[axis];
    const Boxes boxes = box.wrap(from_corner).boxes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::abs(boxes[axis]) <= most_images) continue;
      row.reject(fmt::format("position {} = {}: expected one at most {} boxes away", "xyz"[axis],
                             read[axis], most_images));
    }
    image = shift_of(boxes);
    if (columns_.scaled) image = tilt_.counted(image);
    // With one rounding, so that a position comes back as it was wrapped.
    r = box.less(r, boxes);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double edge = state.box[axis], lower = columns_.lower[axis];
    const bool periodic = state.periodic[axis];
    // A box that is not periodic begins at 0, as walls lie at 0 and at the edge, and so does one in
    // which there may be a flow.
    const bool begins_at_0 = !periodic || columns_.tilt != 0;
    if (columns_.scaled) r[axis] = (begins_at_0 ? 0 : lower) + r[axis] * edge;
    if (columns_.scaled && axis == 0 && columns_.tilt != 0) r[0] += columns_.tilt * r[1];
    if (!columns_.scaled && begins_at_0) r[axis] -= lower;
    if (!std::isfinite(r[axis])) {
      row.reject(fmt::format("position {} = {}: expected a number of boxes that a double can hold",
                             "xyz"[axis], read[axis]));
    }
  }
  state.position.push_back(r);
  if (columns_.unwrapped) {
    state.image.push_back(image);
  } else if (columns_.image) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      image[axis] = static_cast<std::int32_t>(
          row.read_whole((*columns_.image)[axis], "image", -most_images, most_images));
      if (!state.periodic[axis]) image[axis] = 0;
    }
    state.image.push_back(tilt_.counted(image));
  }
}

// As a quaternion says it, or a vector, of length 1 but for a rounding.
Vector NeedleReader::read_director(const Row& row, double& deviation) {
  if (columns_.orientation) {
    const Vector u = read_vector(row, *columns_.orientation, "orientation");
    const double off = std::abs(length_of(u) - 1);
    if (off <= director_tolerance) return u;
    if (!(off <= largest_rounding)) {
      row.reject(
          fmt::format("orientation = ({}, {}, {}), of length {}: expected a unit vector, "
                      "within {}",
                      u[0], u[1], u[2], length_of(u), largest_rounding));
    }
    deviation = off;
    return normalised(u);
  }
  std::array<double, 4> q{};
  for (std::size_t n = 0; n < 4; ++n)
    q[n] = row.read((*columns_.quaternion)[n], fmt::format("quaternion {}", "wxyz"[n]));
  const double size = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  const double off = std::abs(size - 1);
  if (!(off <= largest_rounding)) {
    row.reject(
        fmt::format("quaternion = ({}, {}, {}, {}), of length {}: expected a unit "
                    "quaternion, within {}",
                    q[0], q[1], q[2], q[3], size, largest_rounding));
  }
  if (off > director_tolerance) deviation = off;
  const auto [w, x, y, z] = q;
  return normalised({2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z});
}

void NeedleReader::read_rotation(const Row& row, std::size_t species) {
  double deviation = 0;
  const Vector u = read_director(row, deviation);
  const VectorColumns& columns =
      columns_.angular_velocity ? *columns_.angular_velocity : *columns_.angular_momentum;
  Vector w = read_vector(row, columns, "angular velocity");
  const double length = bodies_.length_of(species, configuration_.material);
  const double part = length == 0 ? 0 : std::abs(part_along(w, u));
  if (!(part <= director_tolerance)) {
    const double along = part * length_of(w);
    if (part <= largest_rounding) {
      deviation = std::max(deviation, part);
    } else if (!columns_.orientation) {
      ++spinning_;
    } else if (along <= rounding_along(row, columns, u)) {
      slow_.push_back({{row.path, row.number, {}}, along});
    } else {
      row.reject(
          fmt::format("angular velocity = ({}, {}, {}), of which {} of its length along the "
                      "orientation: expected none, within {}",
                      w[0], w[1], w[2], part, largest_rounding));
    }
    w = without_part_along(w, u);
  }
  if (deviation > 0) configuration_.roundings.add(deviation);
  configuration_.state.orientation.push_back(u);
  configuration_.state.angular_velocity.push_back(w);
}

void NeedleReader::finish(const std::string& path) {
  require_distinct_ids(path);
  bodies_.settle(configuration_);
  leave_out_unknown_species();
  divide_momenta(path);
  if (spinning_ > 0) {
    configuration_.notes.push_back(fmt::format(
        "{} of {} bodies turn about their own axes, too: that is left out, as it changes nothing",
        spinning_, configuration_.state.size()));
  }
  if (slow_.empty()) return;
  const auto& all = configuration_.state.angular_velocity;
  double size = 0;  // of the vector of all components, without overflow
  for (const Vector& w : all) size = std::hypot(size, length_of(w));
  const double mean = size / std::sqrt(static_cast<double>(all.size()));
  for (const SlowRotation& each : slow_) {
    const double deviation = each.along / mean;
    if (!(deviation <= largest_rounding)) {
      each.place.reject(fmt::format(
          "angular velocity with {} along the orientation, which rounding explains, but which is "
          "{:.3g} of the root mean square of all needles: expected more digits, for at most {}",
          each.along, deviation, largest_rounding));
    }
    configuration_.roundings.add(deviation);
  }
}

void NeedleReader::divide_momenta(const std::string& path) {
  const bool by_mass = !columns_.velocity, by_inertia = !columns_.angular_velocity;
  State& state = configuration_.state;
  if ((!by_mass && !by_inertia) || state.size() == 0) return;
  const Material& material = configuration_.material;
  if (by_mass && material.mass.empty()) {
    throw InputError(fmt::format(
        "{}: momenta without masses: expected a column of masses, or velocities", path));
  }
  const bool is_assumed = material.length.empty() || material.mass.empty() || material.k.empty();
  if (by_inertia && is_assumed) {
    configuration_.notes.push_back(
        "angular velocities are angular momenta over the moments of inertia of the needles "
        "assumed");
  }
  const Composition composition = composition_of(material, path);
  for (std::size_t i = 0; i < state.size(); ++i) {
    const std::size_t index = species_at(state, i);
    if (index >= composition.size()) {
      throw InputError(fmt::format("{}: a needle of species {}: expected an index below {}", path,
                                   index, composition.size()));
    }
    const BodyOfRow body = body_at(composition.species(), state, i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (by_mass) state.velocity[i][axis] /= body.mass;
      if (!by_inertia) continue;
      double& w = state.angular_velocity[i][axis];
      w = body.inertia > 0 ? w / body.inertia : 0;
    }
  }
}

// Species are numbered by what needles say. Numbers that no needle has, in a file that does not
// name its species, are those of no species.
void NeedleReader::leave_out_unknown_species() {
  Material& material = configuration_.material;
  std::vector<SpeciesIndex>& species = configuration_.state.species;
  if (species.empty() || !material.names.empty()) return;
  std::vector<bool> present(most_species);
  for (const SpeciesIndex index : species) present[index] = true;
  std::vector<SpeciesIndex> renumbered(most_species);
  SpeciesIndex count = 0;
  for (std::size_t i = 0; i < most_species; ++i) {
    renumbered[i] = count;
    if (present[i]) ++count;
  }
  for (std::vector<double>* list :
       {&material.length, &material.mass, &material.k, &material.diameter, &material.inertia}) {
    if (list->size() <= 1 && !(list->size() == 1 && std::isnan(list->at(0)))) continue;  // of all
    std::vector<double> kept;
    for (std::size_t i = 0; i < list->size() && i < most_species; ++i) {
      if (present[i]) kept.push_back(list->at(i));
    }
    *list = std::move(kept);
  }
  for (SpeciesIndex& index : species) index = renumbered[index];
  if (count <= 1) species.clear();
}

void NeedleReader::require_distinct_ids(const std::string& path) const {
  std::vector<std::uint32_t> ids = configuration_.state.id;
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice == ids.end()) return;
  throw InputError(fmt::format("{}: id = {} for two needles: expected different ids", path,
                               *twice + columns_.first_id));
}

namespace {

// Names may hold anything. In a text they are a word without commas.
std::string encoded(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = std::isalnum(byte) || c == '-' || c == '_' || c == '.';
    out += plain ? std::string(1, c) : fmt::format("%{:02x}", byte);
  }
  return out;
}

std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      out += static_cast<char>(byte);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::vector<std::string_view> items_of(std::string_view list) {
  std::vector<std::string_view> items;
  for (std::size_t i = 0; i < list.size();) {
    const std::size_t end = std::min(list.find_first_of(", ", i), list.size());
    if (end > i) items.push_back(list.substr(i, end - i));
    i = end + 1;
  }
  return items;
}

}  // namespace

void set_material(Material& material, std::string_view name, std::string_view value,
                  const Row& row) {
  const auto require_first = [&](bool first) {
    if (!first) row.reject(fmt::format("{} twice: expected it once", name));
  };
  if (name == "names") {
    require_first(material.names.empty());
    for (const std::string_view item : items_of(value)) material.names.push_back(decoded(item));
  }
  if (name == "walls") {
    require_first(material.walls.empty());
    for (const std::string_view item : items_of(value)) {
      // "z-low"
      const bool axis = item.size() > 2 && item[0] >= 'x' && item[0] <= 'z' && item[1] == '-';
      const std::string_view side = axis ? item.substr(2) : "";
      if (side != "low" && side != "high") {
        row.reject(fmt::format("walls = {}: expected such as z-low,z-high", quotation(value)));
      }
      Scene::Wall& wall = material.walls.emplace_back();
      wall.axis = item.substr(0, 1);
      wall.side = side;
    }
  }
  if (name == "wall_epsilon") {
    const std::vector<std::string_view> items = items_of(value);
    bool good = !items.empty() && items.size() == material.walls.size();
    for (std::size_t i = 0; good && i < items.size(); ++i) {
      double& epsilon = material.walls[i].epsilon;
      good = read_decimal(items[i], epsilon) == std::errc() && epsilon >= 0 && epsilon <= 1;
    }
    if (!good) {
      row.reject(
          fmt::format("wall_epsilon = {}: expected a number from 0 to 1 for each of walls "
                      "before",
                      quotation(value)));
    }
  }
  if (name == "gravity") {
    const std::vector<std::string_view> items = items_of(value);
    bool good = items.size() == 3;
    for (std::size_t axis = 0; good && axis < 3; ++axis) {
      good = read_decimal(items[axis], material.gravity[axis]) == std::errc();
    }
    if (!good) row.reject(fmt::format("gravity = {}: expected three numbers", quotation(value)));
  }
  for (const auto& [known, member] : materials) {
    if (name != known) continue;
    std::vector<double>& numbers = material.*member;
    require_first(numbers.empty());
    for (const std::string_view item : items_of(value)) {
      double& number = numbers.emplace_back();
      const bool is_fixed =
          (member == &Material::mass || member == &Material::inertia) && is_infinite(item);
      if (is_fixed) number = std::numeric_limits<double>::infinity();
      if (is_fixed || read_decimal(item, number) == std::errc()) continue;
      row.reject(fmt::format("{} = {}: expected a finite number", name, quotation(value)));
    }
    if (numbers.empty()) row.reject(fmt::format("{} =: expected a number", name));
  }
}

void require_no_other_tilt(double xz, double yz, const Row& row) {
  for (const auto& [name, tilt] : {std::pair("xz", xz), {"yz", yz}}) {
    if (tilt == 0) continue;
    row.reject(fmt::format(
        "tilt {} = {}: expected 0, as rows of boxes slide along x by y alone (xy)", name, tilt));
  }
}

void set_flow(State& state, std::string_view name, std::string_view value, const Row& row) {
  if (name != "shear_rate") return;
  if (read_decimal(value, state.shear_rate) != std::errc())
    row.reject(fmt::format("shear_rate = {}: expected a finite number", quotation(value)));
}

std::string text_of_flow(const State& state) {
  return state.shear_rate == 0 ? "" : fmt::format(" shear_rate={}", state.shear_rate);
}

std::array<double, 3> read_edges(std::string_view value, const Row& row) {
  const std::vector<std::string_view> items = items_of(value);
  std::array<double, 3> out{};
  bool good = items.size() == 3;
  for (std::size_t axis = 0; good && axis < 3; ++axis) {
    good = read_decimal(items[axis], out[axis]) == std::errc() && out[axis] > 0;
  }
  if (!good) row.reject(fmt::format("edges = {}: expected three numbers > 0", quotation(value)));
  return out;
}

std::string text_of(const Material& material) {
  std::string text;
  const auto add = [&](const char* name, const auto& items) {
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, fmt::join(items, ","));
  };
  for (const auto& [name, member] : materials) {
    if (!(material.*member).empty()) add(name, material.*member);
  }
  if (material.species() > 1) {
    std::vector<std::string> names;
    for (const Species& each : species_of(material)) names.push_back(encoded(each.name));
    add("names", names);
  }
  if (const auto walls = single_walls(material.walls); !walls.empty()) {
    std::vector<std::string> sides;
    std::vector<double> epsilon;
    for (const Scene::Wall& wall : walls) {
      sides.push_back(wall.axis + "-" + wall.side);
      epsilon.push_back(wall.epsilon);
    }
    add("walls", sides);
    add("wall_epsilon", epsilon);
  }
  if (material.gravity != std::array<double, 3>{}) add("gravity", material.gravity);
  return text;
}

}  // namespace needlework::io
