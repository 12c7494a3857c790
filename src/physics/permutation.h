// Permutations of needles and of the data stored with them.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "src/physics/ids.h"

namespace needlework {

/// The inverse of a permutation: ranks[order[n]] = n.
inline std::vector<Needle> ranks_of(const std::vector<Needle>& order) {
  std::vector<Needle> ranks(order.size());
  for (std::size_t n = 0; n < order.size(); ++n) ranks[order[n]] = Needle(n);
  return ranks;
}

/// Permutes values in place, because a second copy of all records would be the largest use of
/// memory in a run.
template <class Values>
void permute(Values& values, const std::vector<Needle>& order) {
  std::vector<bool> placed(values.size());
  for (std::size_t start = 0; start < values.size(); ++start) {
    if (placed[start]) continue;
    typename Values::value_type first = std::move(values[start]);
    std::size_t n = start;
    for (; order[n].index != start; n = order[n]) {
      values[n] = std::move(values[order[n]]);
      placed[n] = true;
    }
    values[n] = std::move(first);
    placed[n] = true;
  }
}

}  // namespace needlework
