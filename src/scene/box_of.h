// The box that a scene asks for.
#pragma once

#include "needlework/scene.h"
#include "src/box/box.h"

namespace needlework {

inline Box box_of(const Scene& scene) { return {scene.needles.box, scene.periodic()}; }
/// The same at time 0, if rows of boxes slide.
inline Box box_at_start(const Scene& scene) {
  if (!scene.shear) return box_of(scene);
  const Shear shear(scene.shear->rate, scene.needles.box, scene.shear->offset);
  return box_of(scene).with_rows(shear.at(0, 0));
}

}  // namespace needlework
