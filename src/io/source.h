// HDF5 files to read from: H5MD elements and their rows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/io/hdf5.h"

namespace needlework::io {

/// A file open for reading.
class Source {
 public:
  /// Throws IoError if there is no such file or it is no whole HDF5 file.
  explicit Source(const std::string& path);

  hid_t get() const { return file_.get(); }
  const std::string& path() const { return path_; }
  std::uint64_t bytes() const { return bytes_; }

  /// "PATH: /OBJECT", the beginning of every message.
  std::string place(const std::string& object) const { return path_ + ": " + object; }

 private:
  std::string path_;
  std::uint64_t bytes_ = 0;
  hdf5::Handle file_;
};

/// An H5MD element: a group with value and perhaps step and time, or a plain dataset.
class Element {
 public:
  /// Throws InputError if `path` is neither, or has no numbers in it.
  Element(const Source& source, const std::string& path);

  /// Name of the dataset that has the values, such as "/particles/needles/id".
  const std::string& name() const { return name_; }
  const hdf5::Shape& shape() const { return shape_; }
  bool is_group() const { return is_group_; }

  /// Rows that are complete: what has a step, where there are steps. In a plain dataset and in a
  /// file that was closed, the first extent.
  hsize_t rows() const { return rows_; }
  /// One a row; nothing if the element has none. Throws InputError if they are not in order.
  const std::optional<std::vector<std::int64_t>>& steps() const { return steps_; }
  /// The same for the times.
  std::optional<std::vector<double>> times() const;

  /// Reads row `row`, or everything if `row` is empty, converted to Number.
  template <class Number>
  std::vector<Number> read(std::optional<hsize_t> row) const {
    std::vector<Number> values(size(row));
    read_as(hdf5::type_of<Number>(), row, values.data());
    return values;
  }
  /// The same into memory with room for size(row) numbers.
  void read_as(hid_t type, std::optional<hsize_t> row, void* values) const;
  std::size_t size(std::optional<hsize_t> row) const;

 private:
  template <class Number>
  std::optional<std::vector<Number>> read_grid(const char* name) const;

  const Source* source_;
  std::string path_;
  std::string name_;
  bool is_group_;
  hdf5::Handle value_;
  hdf5::Shape shape_;
  hsize_t rows_ = 0;
  std::optional<std::vector<std::int64_t>> steps_;
};

/// The group to read of a file: /particles/needles, or the only one under /particles.
std::string find_particles(const Source& source);

}  // namespace needlework::io
