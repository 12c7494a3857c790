// HDF5 files for fuzz targets: valid files whose objects are replaced, as the bytes of the fuzzer
// say. Flipping bytes of files would test HDF5 rather than what reads the objects.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <string>
#include <vector>

#include "src/io/hdf5.h"

namespace needlework::fuzz {

/// A valid HDF5 file and the paths of its objects.
class BaseFile {
 public:
  explicit BaseFile(std::string path);

  /// Copies the file to `path` and applies edits until `data` has no bytes left.
  void edit(const std::string& path, FuzzedDataProvider& data) const;

 private:
  std::string path_;
  std::vector<std::string> objects_;
};

}  // namespace needlework::fuzz
