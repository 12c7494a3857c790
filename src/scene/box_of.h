// The box that a scene asks for.
#pragma once

#include "needlework/scene.h"
#include "src/box/box.h"

namespace needlework {

inline Box box_of(const Scene& scene) { return {scene.needles.box, scene.periodic()}; }

}  // namespace needlework
