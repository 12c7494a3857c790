// The order in which needles are stored: along a space-filling curve, so that neighbours in space
// are neighbours in memory.
#pragma once

#include <utility>
#include <vector>

#include "src/physics/gas.h"

namespace needlework {

/// The needles in the order of a Morton curve (bits of the coordinates interleaved) through their
/// centres at `now`; equal ones keep their order.
std::vector<Needle> order_in_space(const Gas& gas, Time now);

/// Stores the needles of the gas in this order, touches included.
void reorder(Gas& gas, const std::vector<Needle>& order);

/// rank[order[n]] = n
std::vector<Needle> ranks_of(const std::vector<Needle>& order);

/// Puts values into the new order, in place: a second copy of all records would be the most memory
/// that a run ever needs.
template <class T>
void permute(std::vector<T>& values, const std::vector<Needle>& order) {
  std::vector<bool> placed(values.size());
  for (std::size_t start = 0; start < values.size(); ++start) {
    if (placed[start]) continue;
    T first = std::move(values[start]);
    std::size_t n = start;
    for (; order[n] != start; n = order[n]) {
      values[n] = std::move(values[order[n]]);
      placed[n] = true;
    }
    values[n] = std::move(first);
    placed[n] = true;
  }
}

}  // namespace needlework
