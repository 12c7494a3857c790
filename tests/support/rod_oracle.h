// An independent oracle for the first contact of two rods of finite width: the distance of the axes
// by comparing all candidates, and nothing known of its change in time but the largest velocity.
// Extended precision first, quad where that is too coarse. No code shared with the engine.
#pragma once

#include "kernels/rod_contact.h"
#include "tests/support/real.h"

namespace needlework::test {

/// Two rods, by value.
struct RodCase {
  kernels::Flight first, second;
  kernels::RodPair pair;  ///< but for the pointers
  double horizon = 0;

  /// A view of this case, which must outlive it.
  kernels::RodPair view() const {
    kernels::RodPair out = pair;
    out.first = &first;
    out.second = &second;
    return out;
  }
  RodCase exchanged() const;
};

struct RodAnswer {
  bool contact = false;
  Quad time = 0;
  bool undecided = false;  ///< the distance stays within quad's rounding of that at contact
  std::uint64_t evaluations = 0;
};

/// The first contact in [0, horizon] by the rule of kernels::rod_contact().
RodAnswer first_rod_contact(const RodCase& rods);

/// Distance of the axes at time s.
Quad rod_distance(const RodCase& rods, const Quad& s);

}  // namespace needlework::test
