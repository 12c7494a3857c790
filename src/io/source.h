// Reading of HDF5 files: H5MD elements and their rows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/io/hdf5.h"

namespace needlework::io {

/// An HDF5 file that is open for reading. If a run is writing it, its datasets have the rows that
/// they had when it was opened.
class Source {
 public:
  /// Throws IoError if the file does not exist or is not a complete HDF5 file.
  explicit Source(const std::string& path);

  hid_t get() const { return file_.get(); }
  const std::string& path() const { return path_; }
  std::uint64_t bytes() const { return bytes_; }
  /// Throws InputError for a dataset of so many numbers if a file of this size cannot hold them,
  /// even compressed: before memory is taken for them.
  void require_possible(std::uint64_t numbers, const std::string& dataset) const;

  /// "PATH: /OBJECT", with which every message begins.
  std::string place(const std::string& object) const { return path_ + ": " + object; }

 private:
  void hold_datasets();

  std::string path_;
  std::uint64_t bytes_ = 0;
  hdf5::Handle file_;
  std::vector<hdf5::Handle> held_;
};

/// An H5MD element, which is a group with the dataset value and optionally step and time, or a
/// plain dataset, which is read like an element without step and time.
class Element {
 public:
  /// Throws InputError if `path` is neither, if its values are not numbers,
  /// or if its steps decrease.
  Element(const Source& source, const std::string& path);

  /// Path of the dataset with the values, such as "/particles/needles/id".
  const std::string& name() const { return name_; }
  const hdf5::Shape& shape() const { return shape_; }
  bool is_group() const { return is_group_; }

  /// Number of complete rows. An element with steps has as many complete rows as steps; otherwise
  /// all rows are complete.
  hsize_t rows() const { return rows_; }
  /// The step of each row, or nothing if the element has no steps.
  const std::optional<std::vector<std::int64_t>>& steps() const { return steps_; }
  /// The time of each row, or nothing if the element has no times.
  std::optional<std::vector<double>> times() const;

  /// Reads one row, or all rows if `row` is empty, converted to Number.
  template <class Number>
  std::vector<Number> read(std::optional<hsize_t> row) const {
    std::vector<Number> values(size(row));
    read_as(hdf5::type_of<Number>(), row, values.data());
    return values;
  }
  /// Reads the same numbers into `values`, which must have space for size(row) numbers of `type`.
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

/// The group of particles to read: /particles/needles, or the only group under /particles.
std::string find_particles(const Source& source);

}  // namespace needlework::io
