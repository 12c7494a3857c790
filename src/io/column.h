// Datasets that grow: one row a frame, a sample or an event.
#pragma once

#include <string>

#include "src/io/hdf5.h"

namespace needlework::io {

/// A chunked dataset [rows][row...] that is extended at its end.
class Column {
 public:
  /// Makes one without rows in `group`. `row` is the shape of one row, zeros allowed; `chunk_rows`
  /// rows are stored in one piece.
  static hdf5::Handle create(hid_t group, const std::string& name, hid_t type,
                             const hdf5::Shape& row, hsize_t chunk_rows, const std::string& place);

  /// Opens the one at `path`, seen from `parent`.
  Column(hid_t parent, const std::string& path, const std::string& place);

  /// Writes `count` rows, in C order, after the last one.
  template <class Number>
  void append(const Number* values, hsize_t count) {
    append_as(hdf5::type_of<Number>(), values, count);
  }

 private:
  void append_as(hid_t type, const void* values, hsize_t count);

  std::string place_;
  hdf5::Handle dataset_;
  hdf5::Shape shape_;
};

}  // namespace needlework::io
