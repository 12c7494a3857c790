#include "src/io/formats/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "needlework/error.h"
#include "src/io/decimal.h"
#include "src/io/needle_check.h"

namespace needlework::io {
namespace {

using Vector = std::array<double, 3>;

Vector read_vector(const Row& row, const VectorColumns& columns, const char* name) {
  Vector vector;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    vector[axis] = row.read(columns[axis], fmt::format("{} {}", name, "xyz"[axis]));
  }
  return vector;
}

void read_common(const Row& row, std::optional<std::size_t> column, const char* name,
                 std::optional<double>& common) {
  if (!column) return;
  const double value = row.read(*column, name);
  if (!(value > 0)) row.reject(fmt::format("{} = {}: expected a number > 0", name, value));
  if (common && *common != value) {
    row.reject(fmt::format("{} = {}: expected {}, as of the needles before: all are equal", name,
                           value, *common));
  }
  common = value;
}

std::pair<const char*, std::optional<double> Material::*> const materials[] = {
    {"length", &Material::length},
    {"mass", &Material::mass},
    {"k", &Material::k},
    {"epsilon", &Material::epsilon},
    {"beta", &Material::beta}};

}  // namespace

void require_all_vectors(const Columns& columns, const Row& head) {
  for (const auto& [name, vector] :
       {std::pair("position", columns.position), std::pair("velocity", columns.velocity),
        std::pair("orientation", columns.orientation),
        std::pair("angular velocity", columns.angular_velocity)}) {
    if (!vector) head.reject(fmt::format("no {}: expected columns of it", name));
  }
}

void reserve_needles(State& state, const Columns& columns, std::int64_t count, std::size_t bytes) {
  // A digit and a blank, or the end of the line, for each column.
  const std::size_t n = std::min(static_cast<std::size_t>(count), bytes / (2 * columns.count) + 1);
  state.position.reserve(n);
  state.velocity.reserve(n);
  state.orientation.reserve(n);
  state.angular_velocity.reserve(n);
  if (columns.image) state.image.reserve(n);
  if (columns.id) state.id.reserve(n);
}

void read_needle(const Row& row, const Columns& columns, Configuration& configuration) {
  if (row.fields.size() != columns.count) {
    row.reject(fmt::format("{} columns: expected {}", row.fields.size(), columns.count));
  }
  State& state = configuration.state;
  const Vector u = read_vector(row, *columns.orientation, "orientation");
  const Vector w = read_vector(row, *columns.angular_velocity, "angular velocity");
  if (!is_unit(u)) {
    row.reject(
        fmt::format("orientation = ({}, {}, {}), of length {}: expected a unit vector, "
                    "within {}",
                    u[0], u[1], u[2], length_of(u), director_tolerance));
  }
  if (const double part = part_along(w, u); !(std::abs(part) <= director_tolerance)) {
    row.reject(
        fmt::format("angular velocity = ({}, {}, {}), of which {} of its length along the "
                    "orientation: expected none, within {}",
                    w[0], w[1], w[2], part, director_tolerance));
  }
  state.position.push_back(read_vector(row, *columns.position, "position"));
  state.velocity.push_back(read_vector(row, *columns.velocity, "velocity"));
  state.orientation.push_back(u);
  state.angular_velocity.push_back(w);
  if (columns.image) {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    auto& image = state.image.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      image[axis] =
          static_cast<std::int32_t>(row.read_whole((*columns.image)[axis], "image", -most, most));
    }
  }
  if (columns.id) {
    const std::int64_t most = std::numeric_limits<std::uint32_t>::max();
    state.id.push_back(static_cast<std::uint32_t>(
        row.read_whole(*columns.id, "id", columns.first_id, most) - columns.first_id));
  }
  read_common(row, columns.length, "length", configuration.material.length);
  read_common(row, columns.mass, "mass", configuration.material.mass);
}

void require_distinct_ids(const State& state, std::int64_t first_id, const std::string& path) {
  std::vector<std::uint32_t> ids = state.id;
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice == ids.end()) return;
  throw InputError(
      fmt::format("{}: id = {} for two needles: expected different ids", path, *twice + first_id));
}

void set_material(Material& material, std::string_view name, std::string_view value,
                  const Row& row) {
  for (const auto& [known, member] : materials) {
    if (name != known) continue;
    double number = 0;
    if (read_decimal(value, number) != std::errc()) {
      row.reject(fmt::format("{} = {}: expected a finite number", name, value));
    }
    material.*member = number;
  }
}

std::string text_of(const Material& material) {
  std::string text;
  for (const auto& [name, member] : materials) {
    if (material.*member) {
      text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, *(material.*member));
    }
  }
  return text;
}

}  // namespace needlework::io
