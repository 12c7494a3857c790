// Walls of scenes that tests make.
#pragma once

#include <optional>

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

/// A wall of this velocity along its axis, which may come to rest at a place.
inline Scene::Wall piston(const char* axis, const char* side, double velocity,
                          std::optional<double> stop_at = {}, double epsilon = 1) {
  Scene::Wall out = wall(axis, side, epsilon);
  out.motion = Scene::WallMotion{};
  out.motion->velocity = velocity;
  out.motion->stop_at = stop_at;
  return out;
}

/// One of a temperature, which slides along the two other axes.
inline Scene::Wall belt(const char* axis, const char* side, double temperature, double first,
                        double second = 0) {
  Scene::Wall out = wall(axis, side);
  out.temperature = temperature;
  out.motion = Scene::WallMotion{};
  out.motion->tangential = {first, second};
  return out;
}

}  // namespace needlework::test
