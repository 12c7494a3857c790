// What programs are told of the species, the walls, the energy and the pressure of a simulation, by
// a pipe and by `run --json`.
#pragma once

#include <nlohmann/json.hpp>

#include "needlework/simulation.h"

namespace needlework::serve {

/// Adds "species", [{name, count, t_tr, t_rot}] at the present time, and "collisions_by_pair",
/// {"a-b": n} since the start, both in the order of the scene.
void add_species(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "walls", [{axis, side, hits, impulse, pressure}] since the start, in the order of
/// Scene::wall_sides().
void add_walls(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "energy_budget", {pairs, walls: [], thermostat, kicks, velocities_set}, of those that there
/// are.
void add_energy_budget(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "contacts", {entered, ended_by_force, ended_by_tip, ended_by_strike, crowded, time, share}
/// since the start, where needles may slide on each other.
void add_contacts(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "rods", {packing_fraction, virial, pressure, pressure_meaning}, of rods of finite width;
/// the latter two since the start.
void add_rods(nlohmann::ordered_json& json, const Scene& scene, const Simulation& simulation);

}  // namespace needlework::serve
