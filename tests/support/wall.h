// Walls of scenes that tests make.
#pragma once

#include "needlework/scene.h"

namespace needlework::test {

/// A wall at rest.
inline Scene::Wall wall(const char* axis, const char* side, double epsilon = 1) {
  Scene::Wall out;
  out.axis = axis;
  out.side = side;
  out.epsilon = epsilon;
  return out;
}

}  // namespace needlework::test
