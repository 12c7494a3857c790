// The order in which needles are stored: along a space-filling curve, so that neighbours in space
// are neighbours in memory.
#pragma once

#include <vector>

#include "src/physics/gas.h"
#include "src/physics/permutation.h"

namespace needlework {

/// Sorts the needles along a Morton curve (interleaved bits of the coordinates) through their
/// centres at `now`. Needles with equal keys keep their order.
std::vector<Needle> order_in_space(const Gas& gas, Time now);

/// Stores the needles of the gas in this order, touches included.
void reorder(Gas& gas, const std::vector<Needle>& order);

}  // namespace needlework
