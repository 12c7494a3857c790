// The needles of a run as a state describes them.
#pragma once

#include <functional>
#include <string_view>

#include "needlework/scene.h"
#include "needlework/state.h"
#include "src/physics/gas.h"

namespace needlework {

/// Sets the gravity of the scene, of a gas whose box is set.
void set_gravity(Gas& gas, const Scene& scene);
/// Lets rows of boxes slide if the scene says so, from this slide on. To be called when the box is
/// known. [L]
void set_shear(Gas& gas, const Scene& scene, double slide);

/// Makes the needles of a run from a state. Throws InputError for a state that cannot be
/// simulated.
Gas make_gas(const Scene& scene, const State& initial);

/// Throws InputError, "WHAT: ...", if bodies with these velocities along y would be carried to
/// where the flow is faster, all the time. Anything goes where there is no flow, or something of
/// the scene changes that momentum.
void require_steady_flow(const Scene& scene, const Gas& gas, std::string_view what,
                         const std::function<double(Needle)>& velocity_y);

}  // namespace needlework
