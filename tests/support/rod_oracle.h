// An independent oracle for the first contact of two rods of finite width: the distance of the axes
// by comparing all candidates, and nothing known of its change in time but the largest velocity.
// Extended precision first, quad where that is too coarse. No code shared with the engine. A quick
// one answers where it is certain to be right.
#pragma once

#include <optional>

#include "tests/support/real.h"
#include "tests/support/rod_motion.h"

namespace needlework::test {

struct RodAnswer {
  bool contact = false;
  Quad time = 0;
  bool undecided = false;  ///< the distance stays within quad's rounding of that at contact, or too
                           ///< near to it for too long
  std::uint64_t evaluations = 0;
};

/// The first contact in [0, horizon] by the rule of kernels::rod_contact().
RodAnswer first_rod_contact(const RodCase& rods);

/// The same in double or extended precision, which takes a hundredth of the time; nothing for pairs
/// that are not far from every other decision. A time is right to 1e-6 of itself.
std::optional<RodAnswer> quick_rod_contact(const RodCase& rods);

/// Distance of the axes at time s.
Quad rod_distance(const RodCase& rods, const Quad& s);

}  // namespace needlework::test
