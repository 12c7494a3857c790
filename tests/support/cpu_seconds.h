// What code costs, for ratios within one run: those hold on a slow or busy machine as well.
#pragma once

#include <algorithm>
#include <ctime>
#include <limits>

namespace needlework::test {

/// CPU time of this process in `code` [s], the least of three.
template <class Code>
double cpu_seconds(const Code& code) {
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 3; ++n) {
    const std::clock_t begin = std::clock();
    code();
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

}  // namespace needlework::test
