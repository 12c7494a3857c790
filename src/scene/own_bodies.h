// Bodies that have numbers of their own, where those of a species differ.
#pragma once

#include <vector>

#include "needlework/scene.h"
#include "needlework/state.h"
#include "src/composition/sizes.h"

namespace needlework {

/// Those of a body that is as its species says.
BodyNumbers numbers_of(const Species& species);

/// The bodies of all rows of a state, completed by what the scene says of their species; empty where
/// no row has numbers of its own. Throws InputError for numbers out of range, and for species in
/// which some bodies turn, or have width, and others do not.
std::vector<BodyNumbers> own_bodies_of(const Composition& composition, const State& state);

/// The bodies that are drawn for a scene, in order of id; empty if those of each species are alike.
std::vector<BodyNumbers> drawn_bodies(const Scene& scene);

/// The same as columns of a state.
OwnBodies columns_of(const std::vector<BodyNumbers>& bodies);

/// Makes the species of a scene those of the bodies of a state that have numbers of their own;
/// otherwise changes nothing. Throws as own_bodies_of().
void adopt_own_bodies(Scene& scene, const State& state);

}  // namespace needlework
