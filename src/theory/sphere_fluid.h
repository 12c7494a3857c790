// How often spheres of a fluid are in contact.
#pragma once

#include "needlework/composition.h"
#include "src/composition/convex_body.h"

namespace needlework::theory {

/// How many times more often than at low density two spheres of diameters D and D' are in contact,
/// by powers of D D' / (D + D'), in an elastic fluid in equilibrium without order.
struct SphereFluid {
  double constant = 1, linear = 0, square = 0;  ///< [1], [1 / L], [1 / L^2]
};

/// All bodies in a unit of volume, of which rods count by their surfaces and volumes.
ConvexBody fluid_of(const Composition& composition, double volume);

/// In this fluid.
SphereFluid sphere_fluid(const ConvexBody& fluid);

}  // namespace needlework::theory
