// What a file holds at the times of its samples, beside the sums of Totals: its names and shapes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace needlework {

/// One quantity. At each sample it has a row, an array of numbers of this shape.
struct SeriesField {
  struct Extent {
    std::string name;  ///< for people, such as "bins"; a number where it is always the same
    std::size_t size;
  };
  enum class Kind {
    real,     ///< one row for each sample, of double precision
    count,    ///< one row for each sample, of whole numbers
    constant  ///< the same for the whole run, without rows
  };

  std::string name;
  std::string meaning;  ///< a sentence without its full stop
  std::string unit;     ///< in words; empty where there is none
  std::vector<Extent> shape = {};
  Kind kind = Kind::real;
  std::vector<double> values = {};  ///< of a constant

  /// Numbers in one row.
  std::size_t width() const {
    std::size_t product = 1;
    for (const Extent& extent : shape) product *= extent.size;
    return product;
  }
};

/// Quantities that belong together, in a group of their own.
struct SeriesGroup {
  std::string name;
  std::string meaning;
  std::vector<SeriesField> fields;
};

}  // namespace needlework
