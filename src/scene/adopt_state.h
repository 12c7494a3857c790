// What a scene takes from the state that it starts from.
#pragma once

#include <cstddef>
#include <string>

#include "needlework/scene.h"
#include "needlework/state.h"

namespace needlework {

/// Completes a scene that starts from a given state, read from scene.initial.file if that is not
/// empty, with its count, box and bodies. What the scene says itself must agree, numbers to a
/// relative 1e-12; otherwise throws InputError: "PLACE: expected ..., as in FILE". So it does for
/// bodies that the rest of the scene is not made for, see require_rules(). A count that the scene
/// does not give is attributed to the file in later messages. Of bodies that differ, the state gets
/// the numbers that it lacks: see all_numbers_of().
void adopt_state(Scene& scene, State& state);
/// The part of it that is about the count, so that it can be asked before the state is read. Fills
/// in nothing.
void require_count(const Scene& scene, std::size_t count);

/// The part of it that is about the bodies but for their counts.
void adopt_bodies(Scene& scene, const Bodies& bodies);

/// What a state says of these species: with names, where there are several; with sizes larger by
/// this factor of growth.
Bodies bodies_of(const Composition& composition, double scale = 1);

/// A warning if initial.file does not say all of its bodies, and neither does the scene; else
/// empty.
std::string warning_of_unknown_bodies(const Scene& scene, const Bodies& bodies);

}  // namespace needlework
