// Which rows of a long list are shown.
#pragma once

#include <cstddef>
#include <vector>

namespace needlework::report {

/// What a page holds at the most, so that a browser opens it quickly.
struct PageLimits {
  std::size_t needles = 20000;        ///< of one frame
  std::size_t frames = 200;           ///< of one file
  std::size_t drawn = 600000;         ///< needles of all frames of a file together
  std::size_t samples = 4000;         ///< of a curve
  std::size_t group_bytes = 8 << 20;  ///< of all datasets of an observable
};

/// `most` of the numbers 0 to count - 1, evenly, with the first and the last; all if there are not
/// more. With `most` = 1 the last alone.
std::vector<std::size_t> evenly(std::size_t count, std::size_t most);

}  // namespace needlework::report
