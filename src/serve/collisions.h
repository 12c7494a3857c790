// Collisions as arrays, one field each.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/collision.h"
#include "src/serve/requests.h"

namespace needlework::serve {

/// The names of all fields.
std::span<const std::string_view> collision_fields();
/// Those that are sent where none are named: all but the states after the collision.
std::vector<std::string> usual_collision_fields();

/// An object with an array in base64 for each of these fields.
Json collisions_as_arrays(std::span<const Collision> collisions,
                          std::span<const std::string> fields);

}  // namespace needlework::serve
