// The accuracy settings of a scene.
#pragma once

#include <string>

#include "needlework/accuracy.h"
#include "needlework/scene.h"

namespace needlework {

/// The settings of the level, with those that the scene sets by themselves. Throws InputError for
/// an unknown name.
Accuracy accuracy_of(const Scene::Engine& engine);

/// For example "standard" or "standard, isolation sampling".
std::string accuracy_name(const Scene::Engine& engine);

}  // namespace needlework
