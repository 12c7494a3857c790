// What a scene asks of the search for first contacts.
#pragma once

#include <string>

#include "needlework/accuracy.h"
#include "needlework/scene.h"

namespace needlework {

/// The level, with those knobs that the scene sets. Throws InputError for a name that does not
/// exist.
Accuracy accuracy_of(const Scene::Engine& engine);

/// Such as "standard" or "standard, isolation sampling".
std::string accuracy_name(const Scene::Engine& engine);

}  // namespace needlework
