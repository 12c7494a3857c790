// The list of all observables.
#pragma once

#include <span>
#include <string_view>

#include "src/observe/observable.h"

namespace needlework::observe {

struct Entry {
  std::string_view name;     ///< in output.observables, and of the group in /series
  std::string_view meaning;  ///< of that group: a sentence without its full stop
  ObservablePointer (*make)(const GasSetting& gas);
  /// Whether it reads the species of needles, as pairs of them need; others are made for each.
  bool knows_species = false;
};
inline constexpr std::string_view displacement_name = "displacement";

/// In the order of observable_names.
std::span<const Entry> registry();

// Each in a file of its own, NAME.cpp, which begins with its definition.
ObservablePointer make_fields(const GasSetting& gas);
ObservablePointer make_profiles(const GasSetting& gas);
ObservablePointer make_flow_order(const GasSetting& gas);
ObservablePointer make_distributions(const GasSetting& gas);
ObservablePointer make_alignment(const GasSetting& gas);
ObservablePointer make_velocity_moments(const GasSetting& gas);
ObservablePointer make_temperature_by_axis(const GasSetting& gas);
ObservablePointer make_pair_correlation(const GasSetting& gas);
ObservablePointer make_structure_factor(const GasSetting& gas);
ObservablePointer make_displacement(const GasSetting& gas);
ObservablePointer make_time_correlation(const GasSetting& gas);
ObservablePointer make_collision_statistics(const GasSetting& gas);
ObservablePointer make_wall_profiles(const GasSetting& gas);
ObservablePointer make_centre_of_mass(const GasSetting& gas);
ObservablePointer make_contact_network(const GasSetting& gas);
ObservablePointer make_pressure_tensor(const GasSetting& gas);

}  // namespace needlework::observe
