// Collisions, and all that happens, as arrays, one field each.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/happening.h"
#include "src/serve/requests.h"

namespace needlework::serve {

/// The names of all fields; those of collisions alone have no `kind`.
std::span<const std::string_view> report_fields(bool with_kind);
/// Those that are sent where none are named: all but the states after the event.
std::vector<std::string> usual_fields(bool with_kind);

/// An object with an array in base64 for each of these fields.
Json as_arrays(std::span<const Collision> collisions, std::span<const std::string> fields);
Json as_arrays(std::span<const Happening> happenings, std::span<const std::string> fields);

}  // namespace needlework::serve
