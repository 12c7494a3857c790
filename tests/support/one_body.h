// States of one body.
#pragma once

#include <array>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework::test {

inline State state_of(const Scene& scene, const std::array<double, 3>& r,
                      const std::array<double, 3>& u, const std::array<double, 3>& v,
                      const std::array<double, 3>& w) {
  State out;
  out.resize(1);
  out.box = scene.needles.box;
  out.position[0] = r;
  out.orientation[0] = u;
  out.velocity[0] = v;
  out.angular_velocity[0] = w;
  out.id[0] = 0;
  return out;
}

}  // namespace needlework::test
