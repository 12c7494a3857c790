// What needles can be coloured by.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "needlework/state.h"
#include "src/picture/colours.h"
#include "src/picture/ticks.h"

namespace needlework::picture {

/// One number for each needle.
struct NeedleValues {
  std::vector<double> values;
  std::string label;  ///< of the scale of colours
  Range range;        ///< that the colours show; fixed, so that the pictures of a series compare
  Gradient gradient;
};

/// "speed", "spin" and so on.
const std::vector<std::string>& quantities();

/// The component of the mean velocity of each needle and those around it along the axis x, y or z,
/// in units of (T_tr / m)^1/2, is called "flow-x" and so on.
inline constexpr const char* flow_along[] = {"flow-x", "flow-y", "flow-z"};

/// Of each needle: in a uniform flow the peculiar velocity, which is the same for all images, and
/// otherwise the velocity. [L / time]
std::vector<std::array<double, 3>> velocities_beside_flow(const State& state);

/// The values of one of the quantities, those of velocities beside a uniform flow, for a ground
/// that is dark or light. Throws std::invalid_argument for another name.
NeedleValues values_of(const std::string& quantity, const State& state, bool dark);

}  // namespace needlework::picture
