// Everything that is in an HDF5 file, for comparing files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/io/support.h"

namespace needlework::io {

/// A dataset of numbers or texts.
struct Content {
  hdf5::Shape shape;
  std::vector<double> numbers;
  std::vector<std::string> texts;

  friend bool operator==(const Content&, const Content&) = default;

  /// The text of one row, if the dataset is one of texts.
  std::string text(std::size_t index) const { return texts.empty() ? "" : texts.at(index); }
  /// The numbers of one row.
  std::vector<double> row(std::size_t index) const {
    const std::size_t width = shape[0] == 0 ? 0 : numbers.size() / shape[0];
    const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(index * width);
    return {begin, begin + static_cast<std::ptrdiff_t>(width)};
  }
};

/// The datasets by their paths.
using Recorded = std::map<std::string, Content>;

inline void read_group(hid_t file, const std::string& group, Recorded& contents) {
  const hdf5::Handle opened = hdf5::open_group(file, group + "/", group);
  for (const std::string& name : hdf5::children(opened.get(), group)) {
    const std::string path = group + "/" + name;
    if (hdf5::is_group(file, path, path)) {
      read_group(file, path, contents);
      continue;
    }
    const hdf5::Handle data = hdf5::open_dataset(file, path, path);
    Content& content = contents[path];
    content.shape = hdf5::shape_of(data.get(), path);
    if (hdf5::type_name(data.get(), path) == "string") {
      content.texts = hdf5::read_strings(data.get(), path);
      continue;
    }
    std::size_t size = 1;
    for (const hsize_t extent : content.shape) size *= extent;
    content.numbers.resize(size);
    hdf5::check(H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                        content.numbers.data()),
                path);
  }
}

/// Reads the file as any other program does.
inline Recorded read_contents(const std::string& path) {
  const hdf5::Session session;
  const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path);
  Recorded contents;
  read_group(file.get(), "", contents);
  return contents;
}

inline void expect_same(const Recorded& expected, const Recorded& found) {
  for (const auto& [path, content] : expected) {
    const auto at = found.find(path);
    ASSERT_NE(at, found.end()) << path;
    EXPECT_EQ(hdf5::to_string(content.shape), hdf5::to_string(at->second.shape)) << path;
    EXPECT_TRUE(content == at->second) << path;
  }
  EXPECT_EQ(expected.size(), found.size());
}

}  // namespace needlework::io
