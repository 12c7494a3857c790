// What `needlework theory --boltzmann` says of a gas: a direct simulation of the Boltzmann
// equation, beside kinetic theory.
#pragma once

#include <optional>
#include <string>

#include "needlework/boltzmann.h"

namespace needlework::cli {

/// The temperatures at these times with their errors, of a mixture by species too, beside those of
/// kinetic theory for Gaussian velocities, as a table or as one JSON object. A mixture needs its
/// density [L^-3]. Throws std::invalid_argument as simulate() does.
std::string boltzmann_theory_of(const boltzmann::Settings& settings,
                                const std::vector<double>& taus, std::optional<double> density,
                                bool json);

}  // namespace needlework::cli
