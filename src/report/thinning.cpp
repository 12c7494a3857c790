#include "src/report/thinning.h"

#include <algorithm>
#include <numeric>

namespace needlework::report {

std::vector<std::size_t> evenly(std::size_t count, std::size_t most) {
  most = std::max<std::size_t>(most, 1);
  std::vector<std::size_t> chosen(std::min(count, most));
  if (count <= most) {
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  } else if (most == 1) {
    chosen[0] = count - 1;
  } else {
    for (std::size_t n = 0; n < most; ++n) chosen[n] = n * (count - 1) / (most - 1);
  }
  return chosen;
}

}  // namespace needlework::report
