// Where a body is and how it moves, at one time.
#pragma once

#include "kernels/vec3.h"

namespace needlework::kernels {

struct BodyState {
  Vec3d r, v;  ///< centre and its velocity [L, L / time]
  Vec3d u, w;  ///< director and angular velocity, normal to it [1, 1 / time]
};

}  // namespace needlework::kernels
