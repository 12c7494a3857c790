// The format:
// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html#vtkhdf-file-format
#include "src/io/vtkhdf.h"

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "src/io/atomic_file.h"
#include "src/io/descriptions.h"
#include "src/io/hdf5.h"
#include "src/io/needle_ends.h"
#include "src/io/output_file.h"

namespace needlework::io {

using hdf5::create_group;
using hdf5::Handle;
using hdf5::write_array;

namespace {

using Vectors = std::vector<std::array<double, 3>>;

constexpr std::uint8_t vtk_line = 3;

void write_vectors(hid_t group, const char* name, const Vectors& vectors,
                   const std::string& place) {
  const double* first = vectors.empty() ? nullptr : vectors.front().data();
  write_array<double>(group, name, {vectors.size(), 3}, {first, 3 * vectors.size()}, place);
}

void write_counter(hid_t group, const char* name, std::size_t value, const std::string& place) {
  // The format has one number for each part of the grid. This grid has one part.
  const auto count = static_cast<std::int64_t>(value);
  write_array<std::int64_t>(group, name, {1}, {&count, 1}, place);
}

void write_lines(hid_t group, const State& state, const std::vector<double>& lengths,
                 const std::string& place) {
  const std::size_t count = state.size();
  write_counter(group, "NumberOfPoints", 2 * count, place);
  write_counter(group, "NumberOfCells", count, place);
  write_counter(group, "NumberOfConnectivityIds", 2 * count, place);
  write_vectors(group, "Points", ends_of(state, lengths), place);
  std::vector<std::int64_t> points(2 * count);
  std::iota(points.begin(), points.end(), 0);
  write_array<std::int64_t>(group, "Connectivity", {points.size()}, points, place);
  std::vector<std::int64_t> offsets;
  for (std::size_t i = 0; i <= count; ++i) offsets.push_back(static_cast<std::int64_t>(2 * i));
  write_array<std::int64_t>(group, "Offsets", {offsets.size()}, offsets, place);
  write_array<std::uint8_t>(group, "Types", {count}, std::vector(count, vtk_line), place);
}

void write_cell_data(hid_t group, const State& state, const std::string& place) {
  std::vector<std::uint32_t> ids = state.id;
  if (ids.empty()) {
    ids.resize(state.size());
    std::iota(ids.begin(), ids.end(), 0u);
  }
  write_array<std::uint32_t>(group, "id", {ids.size()}, ids, place);
  write_vectors(group, "velocity", state.velocity, place);
  write_vectors(group, "orientation", state.orientation, place);
  write_vectors(group, "angular_velocity", state.angular_velocity, place);
}

// What ends of lines have in common.
void write_point_data(hid_t root, const State& state, const std::vector<double>& diameters,
                      const std::string& place) {
  const OwnBodies& own = state.own_bodies;
  if (diameters.empty() && own.empty()) return;
  const Handle group = create_group(root, "PointData", place);
  const auto write = [&](const char* name, const std::vector<double>& values) {
    if (!values.empty()) write_array<double>(group.get(), name, {values.size()}, values, place);
  };
  if (!diameters.empty()) write("radius", radii_of_ends(state, diameters));
  write("length", at_both_ends(own.length));
  write("mass", at_both_ends(own.mass));
}

}  // namespace

void write_vtkhdf(const std::string& path, bool force, const State& state,
                  const std::vector<double>& lengths, const std::vector<double>& diameters) {
  const hdf5::Session session;
  AtomicFile atomic(path, force);
  OutputFile file(atomic.temporary(), path, OutputFile::Use::in_one_go);
  {
    const Handle root = create_group(file.get(), "VTKHDF", path);
    const std::array<std::int32_t, 2> version{1, 0};
    hdf5::write_attribute(root.get(), "Version", version, {2}, path);
    hdf5::write_attribute(root.get(), "Type", std::string("UnstructuredGrid"), path);
    if (state.periodic != std::array{true, true, true}) {
      // Readers pass over it. Of a box that is periodic throughout, nothing is said.
      const std::array<std::int32_t, 3> periodic{state.periodic[0], state.periodic[1],
                                                 state.periodic[2]};
      hdf5::write_attribute(root.get(), "periodic", periodic, {3}, path);
    }
    write_lines(root.get(), state, lengths, path);
    write_point_data(root.get(), state, diameters, path);
    write_cell_data(create_group(root.get(), "CellData", path).get(), state, path);
  }
  write_descriptions(file.get(), vtkhdf_descriptions(), path);
  file.close();
  atomic.publish();
}

}  // namespace needlework::io
