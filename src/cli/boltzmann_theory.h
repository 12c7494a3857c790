// What `needlework theory --boltzmann` says of a gas: a direct simulation of the Boltzmann
// equation, beside kinetic theory.
#pragma once

#include <optional>
#include <string>

#include "needlework/boltzmann.h"

namespace needlework::cli {

/// What tau of the theory, (2/3) sqrt(pi) n t, is multiplied by so that it counts in the thermal
/// speed at the start, sqrt(T_tr(0)): as tau is read and printed. 1 where nothing flies at first.
double tau_scale(double initial_t_tr);

/// The temperatures at these times with their errors, of a mixture by species too, beside those of
/// kinetic theory for Gaussian velocities, as a table or as one JSON object. A mixture needs its
/// density [L^-3]. Throws std::invalid_argument as simulate() does.
std::string boltzmann_theory_of(const boltzmann::Settings& settings,
                                const std::vector<double>& taus, std::optional<double> density,
                                bool json);

}  // namespace needlework::cli
