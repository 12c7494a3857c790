// First contact of two spheres of finite width in free flight: nearly always by a quadratic
// equation in double, in double-double where that leaves a doubt. What is promised of rods
// (kernels/rod_contact.h) holds of these functions, too.
#pragma once

#include "kernels/first_contact.h"
#include "kernels/rod_pair.h"
#include "needlework/accuracy.h"

namespace needlework::kernels {

inline bool are_spheres(const RodPair& pair) {
  return pair.half_first == 0 && pair.half_second == 0;
}

/// As rod_contact(), of which it is a special case.
Contact sphere_contact(const RodPair& pair, double until, EvaluationCounters& counters,
                       const Accuracy& accuracy = standard_accuracy);

/// As rod_geometry(); both arms are 0.
ContactGeometry sphere_geometry(const RodPair& pair, const DoubleDouble& elapsed);

/// As rod_time_apart(): spheres that fly apart do not meet again at all.
double sphere_time_apart(const RodPair& pair);

}  // namespace needlework::kernels
