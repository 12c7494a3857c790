// Collision rates that are known exactly before a gas runs: in a state that is drawn, and in the
// equilibrium of elastic needles.
#pragma once

#include <vector>

#include "needlework/scene.h"
#include "src/runs/loaded_scene.h"

namespace needlework::runs {

/// Collisions of each two species per time at the start by kinetic theory, by
/// Composition::pair_index: exact for a state that is drawn, whatever each body is, also of alike
/// ones between two walls along one axis; of rods and spheres at low density. [1 / time]
std::vector<double> initial_rates_by_pair(const LoadedScene& loaded);
/// The same with the contact values of a fluid, theory::contact_values(). [1 / time]
std::vector<double> initial_contacts_by_pair(const LoadedScene& loaded);
/// The same at low density as mean free times count them, by which t_c and windows go: all bodies
/// of a species have its means, and thin needles are partners of themselves, so that equal ones
/// have one free time in one species and in several. [1 / time]
std::vector<double> counted_rates_by_pair(const LoadedScene& loaded);
/// The latter as collisions that a needle which moves takes part in, on average. [1 / time]
double initial_collision_rate(const LoadedScene& loaded);
/// Rates by pair of species as collisions that a needle which moves takes part in. [1 / time]
double per_moving_needle(const Composition& composition, const std::vector<double>& by_pair);

/// Whether all is known of the gas from the start: elastic needles that are drawn with equal
/// temperatures, but for fixed ones, which nothing changes. Elastic walls at rest may be around
/// them, or thermal ones of this temperature, and they may have a thermostat of it.
bool starts_in_equilibrium(const Scene& scene);

/// Collisions of each two species per time in a gas that starts in equilibrium, by
/// Composition::pair_index, at this energy per needle that moves, or at the temperature of its heat
/// bath: exact for any number of needles, whatever each of them is. Needles that meet fixed ones
/// alone keep the energies that they are drawn with. Alike needles may be between walls along one
/// axis. Empty where rates are not known: of rods of finite width, between other walls, where some
/// needles share their energy and others do not, and of a gas that does not start in equilibrium.
/// [1 / time]
std::vector<double> equilibrium_rates_by_pair(const Scene& scene, double energy);
/// The same as collisions that a needle takes part in, on average over all needles, fixed ones
/// among them; NaN where it is not known. [1 / time]
double equilibrium_rate(const Scene& scene, double energy);

}  // namespace needlework::runs
