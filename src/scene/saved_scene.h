// A scene as part of a checkpoint.
#pragma once

#include "needlework/scene.h"
#include "src/archive/archive.h"

namespace needlework {

/// Saves or restores all members of a scene.
void transfer(Archive& archive, Scene& scene);

}  // namespace needlework
