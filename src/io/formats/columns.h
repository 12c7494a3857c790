// Tables of needles in text: which column holds what, and one line read as a needle.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/box/tilt.h"
#include "src/box/vector.h"
#include "src/io/formats/body_columns.h"
#include "src/io/formats/configuration.h"
#include "src/io/formats/lines.h"

namespace needlework::io {

/// The columns of x, y and z of a vector.
using VectorColumns = std::array<std::size_t, 3>;

/// The columns of the components w, x, y and z of a quaternion, of which w is the scalar.
using QuaternionColumns = std::array<std::size_t, 4>;

/// Where the properties of a needle are in a line.
struct Columns {
  std::size_t count = 0;  ///< of all columns
  std::optional<VectorColumns> position, velocity, orientation, angular_velocity, image;
  /// In place of a velocity, a director and an angular velocity, where those are absent. The
  /// quaternion turns (0, 0, 1) into the director.
  std::optional<VectorColumns> momentum, angular_momentum;
  std::optional<QuaternionColumns> quaternion;
  std::optional<std::size_t> id;
  std::int64_t first_id = 0;  ///< the id in the file of the needle whose id is 0
  BodyPlaces bodies;
  std::optional<VectorColumns> force;  ///< not read by NeedleReader
  std::optional<VectorColumns> edges;  ///< of a box whose bounds enclose more; the same in all rows
  std::optional<std::size_t> species;
  std::int64_t first_species = 0;    ///< the number in the file of the species whose index is 0
  bool scaled = false;               ///< positions are multiples of the edges, from `lower`
  bool unwrapped = false;            ///< positions are not wrapped into the box: images follow from
                                     ///< them
  std::array<double, 3> lower = {};  ///< bounds of the box [L]
  double tilt = 0;                   ///< xy of the box, in which images are counted [L]
};

/// What the columns of each vector are called in a format, as messages say it.
struct ColumnNames {
  const char *position, *velocity, *orientation, *angular_velocity;
};

/// Throws InputError, naming what is missing and which columns would do, unless the head of a table
/// names columns for position, velocity, orientation and angular velocity.
void require_all_vectors(const Columns& columns, const ColumnNames& names, const Row& head);

/// Appends the needles of a table to a configuration, line by line.
class NeedleReader {
 public:
  /// `configuration` must outlive this object, and its box must be known. Sets its slide.
  NeedleReader(const Columns& columns, Configuration& configuration);

  /// Takes memory for so many needles that follow, but for no more than a text of so many bytes can
  /// hold.
  void reserve(std::int64_t count, std::size_t bytes);

  /// Appends the needle in a row. Throws InputError if a number cannot be used, if it is another
  /// kind of body than others of its species, and if the director is not a unit vector or the
  /// angular velocity is not normal to it, by more than a rounding of the numbers in the row
  /// explains: see largest_rounding. What is within that is projected. Of bodies with quaternions,
  /// which may turn about their own axes, that part is left out, with a note.
  void read(const Row& row);

  /// Settles which bodies they are, and divides momenta by masses, which must be known, and angular
  /// momenta by moments of inertia. Throws InputError if an id occurs twice, and if what was
  /// projected away from an angular velocity is not small in comparison with those of all needles.
  void finish(const std::string& path);

 private:
  struct SlowRotation {
    Row place;     // without its fields
    double along;  // what was projected away [1 / time]
  };

  void take_edges(const Row& row);
  Vector read_director(const Row& row, double& deviation);
  void divide_momenta(const std::string& path);
  void read_position(const Row& row);
  void read_rotation(const Row& row, std::size_t species);
  void require_distinct_ids(const std::string& path) const;
  void leave_out_unknown_species();

  Columns columns_;
  BodyColumns bodies_;
  Configuration& configuration_;
  Tilt tilt_;
  // Bodies that a quaternion turns, and that turn about their own axes as well.
  std::size_t spinning_ = 0;
  // Of which the rounding of a number with so many decimals is a large part.
  std::vector<SlowRotation> slow_;
};

/// Sets numbers of the material by their name: length, mass, k, epsilon, beta, meet, diameter,
/// names, walls, wall_epsilon or gravity. Several are separated by commas or blanks. Other names
/// are left alone. Throws InputError for what is not a number, or is set already.
void set_material(Material& material, std::string_view name, std::string_view value,
                  const Row& row);
/// The same numbers as text: "length=1 mass=1 k=6 epsilon=0.9 beta=-1", or "length=1,1.5 ...
/// names=short,long" for several species, without those that are absent; then, where there are
/// some, "walls=z-low,z-high wall_epsilon=1,0.9" and "gravity=0,0,-1". Temperature and motion of
/// walls are left out.
std::string text_of(const Material& material);

/// Throws InputError for the tilts of a box that are not those of rows that slide along x.
void require_no_other_tilt(double xz, double yz, const Row& row);

/// What text_of_flow() says, by its name. Throws InputError for what is not a number.
void set_flow(State& state, std::string_view name, std::string_view value, const Row& row);
/// " shear_rate=1.5", or nothing without a flow.
std::string text_of_flow(const State& state);

/// "5,5,6", three numbers above 0: the edges of a box whose bounds enclose more.
std::array<double, 3> read_edges(std::string_view value, const Row& row);

}  // namespace needlework::io
