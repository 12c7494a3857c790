// VTK files of one unstructured grid in XML, with the numbers in binary.
// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html describes the format.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/io/formats/text_file.h"

namespace needlework::io {

/// Arrays of a grid, in the order in which they are written.
class VtuFile {
 public:
  VtuFile(const std::string& path, bool force) : file_(path, force) {}

  /// The part of the grid to which the arrays that follow belong: Points, Cells, PointData,
  /// CellData.
  void begin(std::string_view part);

  /// Adds an array with one or three components for each point or cell.
  void add(std::string_view name, std::vector<double> values, int components);
  void add(std::string_view name, std::vector<std::int64_t> values);
  void add(std::string_view name, std::vector<std::uint8_t> values);

  /// What is said of the grid as a whole.
  void add_field(std::string_view name, std::span<const int> values);

  /// Writes the grid, and gives the file its name.
  void publish(std::size_t points, std::size_t cells);

 private:
  void add_bytes(std::string_view name, std::string_view type, int components, std::string bytes);

  TextFile file_;
  std::string field_, description_;  // in XML
  std::string part_;                 // the one that is open
  std::vector<std::string> bytes_;   // of each array
  std::size_t offset_ = 0;           // of the next array, in the data
};

}  // namespace needlework::io
