// What `needlework theory` says of a mixture.
#pragma once

#include <string>
#include <vector>

#include "src/runs/loaded_scene.h"

namespace needlework::cli {

/// Rates at the start, and the temperatures of each species at these times, in this order, as a
/// table or as one JSON object. Throws InputError for more species than theory follows.
std::string mixture_theory_of(const runs::LoadedScene& loaded, const std::vector<double>& times,
                              bool json);

}  // namespace needlework::cli
