// The density around each needle of a frame.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "needlework/state.h"

namespace needlework::report {

/// For each of the needles `chosen`, the number of other centres within `radius` of its own,
/// nearest images in a periodic box, divided by the volume of that sphere [1/L^3]. The radius must
/// be at most half the shortest edge.
std::vector<float> local_density(const State& state, double radius,
                                 std::span<const std::size_t> chosen);

}  // namespace needlework::report
