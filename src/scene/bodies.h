// Which bodies a scene may be made of.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "needlework/scene.h"

namespace needlework {

/// The key of an entry [[species]] as Scene::places has it.
std::string key_of_species(std::string_view key, std::size_t entry);

/// Throws InputError, "PLACE: expected ...", for bodies that there are none of or that do not go
/// together: thin needles of length 0, needles beside rods of finite width, rough rods, an inertia
/// beside k. Each value on its own must be in its range.
void require_possible_bodies(const Scene& scene);

/// The same for a box in which they have no room, and for [[pairs]] of species that there are none
/// of.
void require_room_in_box(const Scene& scene);
void require_pairs_of_species(const Scene& scene);

}  // namespace needlework
