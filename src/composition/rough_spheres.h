// Which spheres of a composition are rough.
#pragma once

#include "needlework/composition.h"

namespace needlework {

/// Gives spheres that are rough to any sphere, themselves among them, the q of homogeneous ones
/// where they have none, and all others 0.
void set_q_of_spheres(Composition& composition);

}  // namespace needlework
