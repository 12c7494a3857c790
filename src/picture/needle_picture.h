// Needles in their box, as a picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"
#include "src/picture/camera.h"
#include "src/picture/drawing.h"

namespace needlework::picture {

struct NeedlePicture {
  int width = 832, height = 832;  ///< [pixels]
  std::string colour = "speed";   ///< one of quantities()
  bool dark = true;               ///< the ground
  CameraSettings camera;
  std::vector<double> lengths = {
      1.0};                        ///< of needles of each species, where the state has none [L]
  std::vector<double> diameters;   ///< the same, of rods of finite width; none for needles [L]
  std::optional<double> time;      ///< since the start of the scene, shown if it is known
  std::vector<Scene::Wall> walls;  ///< each of one side, not of both
};

/// The needles, whose centres are moved into the box along its periodic axes, and which are drawn
/// whole, so that they reach across its sides. Far ones are thinner and closer to the colour of the
/// ground; rods are as wide as they are. Walls are where they are at that time: those seen from the
/// gas as lattices behind the needles, the others as outlines before them. A side that is open has
/// no edges.
Drawing drawing_of(const State& state, const NeedlePicture& settings);

}  // namespace needlework::picture
