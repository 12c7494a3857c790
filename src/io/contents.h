// What a file holds, by paths, for readers that show whatever is there.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace needlework::io {

/// The groups, datasets and descriptions of an HDF5 file that is open for reading. Paths begin with
/// "/". A dataset is one of HDF5 or an H5MD element, whose path is that of its group.
///
/// Throws IoError, "PATH: reason", if the file cannot be read, and InputError, "PATH: /DATASET:
/// reason", if it does not hold what is asked for. Used by one thread at a time.
class Contents {
 public:
  explicit Contents(const std::string& path);
  Contents(const Contents&) = delete;
  Contents& operator=(const Contents&) = delete;
  ~Contents();

  bool has(const std::string& path) const;
  bool is_dataset(const std::string& path) const;
  /// Names in a group, in alphabetical order; none if there is no such group.
  std::vector<std::string> names(const std::string& group) const;
  /// The attribute `description`, empty if there is none.
  std::string description(const std::string& path) const;

  /// The texts of a dataset of strings, nothing if there is no such dataset or if it holds numbers.
  std::optional<std::vector<std::string>> texts(const std::string& path) const;

  /// Extents of a dataset of numbers. Those of an element begin with the number of complete rows.
  std::vector<std::size_t> shape(const std::string& path) const;
  /// All complete rows of a dataset of numbers.
  std::vector<double> numbers(const std::string& path) const;
  /// These rows alone, one after the other.
  std::vector<double> rows(const std::string& path, std::span<const std::size_t> rows) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace needlework::io
