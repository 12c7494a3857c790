#include "src/observe/registry.h"

#include <algorithm>
#include <iterator>

#include "src/scene/observable_names.h"

namespace needlework::observe {
namespace {

constexpr Entry entries[] = {
    {"fields", "Density, flow and thermal energy in each cell of the grid", make_fields},
    {"profiles", "Density, flow and thermal energy in slabs along each axis", make_profiles},
    {"flow_order", "Order of the flow and inhomogeneity of the density, by cells of the grid",
     make_flow_order},
    {"distributions", "Histograms of local density, velocities and energies", make_distributions},
    {"alignment", "Alignment of the needles with their velocities and with the axes",
     make_alignment},
    {"velocity_moments", "Departure of the velocities from independent Gaussian ones",
     make_velocity_moments},
    {"temperature_by_axis", "Temperatures of the motion along and about each axis",
     make_temperature_by_axis},
    {"pair_correlation", "Correlation of positions and orientations over the distance of a pair",
     make_pair_correlation, true},
    {"structure_factor", "Density fluctuations by wave vector, along each axis",
     make_structure_factor, true},
    {"displacement",
     "Displacement and rotation since reference times, of which a bounded number is kept",
     make_displacement},
    {"time_correlation", "Correlation of motion and velocities in time, at lags of many sizes",
     make_time_correlation},
    {"collision_statistics", "Collisions since the sample before", make_collision_statistics, true},
    {"wall_profiles", "Density, temperatures and order in slabs between walls, or over one",
     make_wall_profiles},
    {"centre_of_mass", "Centre of mass along the axes with walls", make_centre_of_mass, true},
    {"contact_network", "Contacts of bodies that grow, and bodies that few others hold",
     make_contact_network, true},
    {"pressure_tensor",
     "Pressure tensor by flights and by collisions, viscosity and normal stress differences",
     make_pressure_tensor, true},
};

static_assert(std::ranges::equal(entries, observable_names, {}, &Entry::name),
              "expected the names of src/scene/observable_names.h, in their order");

}  // namespace

std::span<const Entry> registry() { return entries; }

}  // namespace needlework::observe
