// The names that output.observables accepts.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "needlework/totals.h"

namespace needlework {

/// Sums over all needles, which every file holds whether they are named or not.
inline constexpr auto total_names = [] {
  constexpr std::size_t count = [] {
    std::size_t sums = 0;
    Totals::for_each_sum([&](const Described&, auto) { ++sums; });
    return sums;
  }();
  std::array<std::string_view, count> names;
  auto name = names.begin();
  Totals::for_each_sum([&](const Described& sum, auto) { *name++ = sum.name; });
  return names;
}();

/// What is computed where a scene names it. src/observe/registry.cpp makes them, and does not
/// compile if it has others.
inline constexpr std::array<std::string_view, 16> observable_names = {
    "fields",           "profiles",         "flow_order",          "distributions",
    "alignment",        "velocity_moments", "temperature_by_axis", "pair_correlation",
    "structure_factor", "displacement",     "time_correlation",    "collision_statistics",
    "wall_profiles",    "centre_of_mass",   "contact_network",     "pressure_tensor"};
/// Those that follow needles, in a flow beside it.
inline constexpr std::array<std::string_view, 2> path_observable_names = {"displacement",
                                                                          "time_correlation"};
/// For which sums are kept from the start of a run. Sheared scenes always have it.
inline constexpr std::string_view pressure_tensor_name = observable_names.back();

/// Of bodies that grow.
inline constexpr std::string_view contact_network_name = "contact_network";

/// Those of axes with walls, for scenes that have some.
inline constexpr std::array<std::string_view, 2> wall_observable_names = {"wall_profiles",
                                                                          "centre_of_mass"};

}  // namespace needlework
