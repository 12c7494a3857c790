// The names of effects, as results say them.
#pragma once

#include <array>
#include <string_view>

namespace needlework {

/// What a scene may call for, in the order in which results have it, after "elastic" or
/// "inelastic".
inline constexpr std::array<std::string_view, 14> effect_names = {
    "rough",   "tc",    "mixture",     "passing", "rods",  "sizes", "fixed",
    "sliding", "walls", "thermostats", "gravity", "kicks", "shear", "growth"};

}  // namespace needlework
