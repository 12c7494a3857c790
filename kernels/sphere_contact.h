// What plain double decides about two spheres, by a quadratic equation: nearly everything. The rest
// is left to the functions of kernels/rod_contact.h, which call these first, and of which these are
// bit for bit.
#pragma once

#include <optional>

#include "kernels/first_contact.h"
#include "kernels/rod_pair.h"

namespace needlework::kernels {

inline bool are_spheres(const RodPair& pair) {
  return pair.half_first == 0 && pair.half_second == 0;
}

/// rod_contact() of two spheres. Nothing where they touch at s = 0, where rounding might decide, or
/// where squares of their numbers might overflow or lose digits.
std::optional<Contact> sphere_contact(const RodPair& pair, double until,
                                      EvaluationCounters& counters);

/// rod_geometry() of two spheres, or nothing for the latter two reasons.
std::optional<ContactGeometry> sphere_geometry(const RodPair& pair, const DoubleDouble& elapsed);

/// rod_time_apart() of two spheres, or nothing if that is not above 0.
std::optional<double> sphere_time_apart(const RodPair& pair);

}  // namespace needlework::kernels
