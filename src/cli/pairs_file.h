// Reads the pairs of needles that `needlework predict` works on.
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/predict.h"

namespace needlework {

struct PairLine {
  std::size_t line = 0;  ///< in the file, from 1
  std::string id;        ///< as written
  FreeNeedle first, second;
  double horizon = 0;
  bool just_collided = false;
};

/// One pair a line: id,family,horizon,r1x,r1y,r1z,u1x,...,w2z,skip (28 columns). Empty lines and
/// lines that start with `#` are passed over, as is a header whose first two columns read
/// "id,family"; the names of columns that it has must be in their places. Throws InputError, "NAME:
/// line N: column X = VALUE: expected ...", at the first bad line, and IoError when reading fails.
std::vector<PairLine> read_pairs(std::istream& in, std::string_view name);

/// The same from a file; "-" is the standard input. Throws IoError when it cannot be opened.
std::vector<PairLine> read_pairs(const std::string& path);

}  // namespace needlework
