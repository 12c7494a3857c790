// Tables of needles in text: which column holds what, and one line read as a needle.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "src/io/formats/configuration.h"
#include "src/io/formats/lines.h"

namespace needlework::io {

/// The columns of x, y and z of a vector.
using VectorColumns = std::array<std::size_t, 3>;

/// Where the properties of a needle are in a line.
struct Columns {
  std::size_t count = 0;  ///< of all columns
  std::optional<VectorColumns> position, velocity, orientation, angular_velocity, image;
  std::optional<std::size_t> id;
  std::int64_t first_id = 0;  ///< the id in the file of the needle whose id is 0
  std::optional<std::size_t> length, mass;
};

/// Throws InputError, naming what is missing, unless the head of a table names columns for
/// position, velocity, orientation and angular velocity.
void require_all_vectors(const Columns& columns, const Row& head);

/// Takes memory for so many needles that follow, but for no more than a text of so many bytes can
/// hold.
void reserve_needles(State& state, const Columns& columns, std::int64_t count, std::size_t bytes);

/// Appends the needle in a row. Throws InputError if a number cannot be used, if the
/// director is not a unit vector or if the angular velocity is not normal to it, and if its length
/// or mass is not that of the needles before.
void read_needle(const Row& row, const Columns& columns, Configuration& configuration);

/// Throws InputError, "PATH: id ...", if an id occurs twice.
void require_distinct_ids(const State& state, std::int64_t first_id, const std::string& path);

/// Sets a number of the material by its name: length, mass, k, epsilon or beta. Other names are
/// left alone.
void set_material(Material& material, std::string_view name, std::string_view value,
                  const Row& row);
/// The same numbers as text: "length=1 mass=1 k=6 epsilon=0.9 beta=-1", without those that are
/// absent.
std::string text_of(const Material& material);

}  // namespace needlework::io
