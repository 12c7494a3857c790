// Three components of any number type. Sums run (x + y) + z, so that exchanging the x and y axes,
// or the factors of a cross product, changes signs only and never a bit.
#pragma once

#include <type_traits>

#include "kernels/inline.h"

namespace needlework {

#include "kernels/vec3_body.h"

using Vec3d = Vec3<double>;

}  // namespace needlework
