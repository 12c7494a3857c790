// Three components, as arrays of states and files hold them.
#pragma once

#include <array>

namespace needlework {

/// A place, velocity, director or angular velocity. Kernels have Vec3d.
using Vector = std::array<double, 3>;

}  // namespace needlework
