// Datasets that grow by one row for each frame, sample or event.
#pragma once

#include <string>

#include "src/io/hdf5.h"

namespace needlework::io {

/// A chunked dataset of shape [rows][row...] to which rows are appended.
class Column {
 public:
  /// Creates the dataset in `group`, without rows. `row` is the shape of one row, in which zeros
  /// are allowed. One chunk of the file holds `chunk_rows` rows.
  static hdf5::Handle create(hid_t group, const std::string& name, hid_t type,
                             const hdf5::Shape& row, hsize_t chunk_rows, const std::string& place);

  /// Opens an existing dataset at `path`, relative to `parent`.
  Column(hid_t parent, const std::string& path, const std::string& place);

  /// Writes `count` rows, in C order, after the last row.
  template <class Number>
  void append(const Number* values, hsize_t count) {
    append_as(hdf5::type_of<Number>(), values, count);
  }
  /// The same for values of any type of HDF5.
  void append_as(hid_t type, const void* values, hsize_t count);

 private:
  std::string place_;
  hdf5::Handle dataset_;
  hdf5::Shape shape_;
};

}  // namespace needlework::io
