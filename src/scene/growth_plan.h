// How far the bodies of a scene grow.
#pragma once

#include <array>

#include "needlework/scene.h"
#include "needlework/stop.h"

namespace needlework {

/// Of a scene with driving.growth.
struct GrowthPlan {
  double start = 1;        ///< sizes at the start as a share of those of the scene
  double largest = 1;      ///< the largest to which they may grow, the same
  Stop end = Stop::grown;  ///< why a run ends there
};
/// For these species, all that follows known, in a box with these edges. Where no packing fraction
/// is asked for, bodies cannot grow beyond what no packing is known to reach, nor beyond the
/// shortest edges that searches and walls need.
GrowthPlan growth_plan(const Scene& scene, const Composition& species,
                       const std::array<double, 3>& box);

/// The same species with lengths and diameters larger by this factor; masses and moments of inertia
/// stay.
Composition enlarged(const Composition& species, double factor);

}  // namespace needlework
