// Results of a simulation as JSON, for a pipe and `run --json`.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>
#include <utility>

#include "needlework/simulation.h"

namespace needlework::json {

/// Adds the numbers of a result under their names; infinity and NaN, which JSON does not have, are
/// null.
template <class Sums>
void add_numbers(nlohmann::ordered_json& json, const Sums& sums) {
  sums.for_each([&](const Described& number, const auto& value) {
    nlohmann::ordered_json& to = json[number.name];
    if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>) {
      if (!std::isfinite(value)) return;
    }
    to = value;
  });
}

/// k of all bodies of a species, the mean where they differ; null of fixed ones.
nlohmann::ordered_json k_of(const Species& species);

/// Adds to a species what makes it other than one of alike bodies that move: "fixed", true, and
/// "sizes", {length: {mean, width, least, greatest, drawn}, ...}, the numbers that differ as they
/// are, and how they are drawn.
void add_sizes(nlohmann::ordered_json& json, const Species& species);

/// Adds "species", [{name, ...}] at the present time, and "collisions_by_pair", {"a-b": n} since
/// the start, both in the order of the scene.
void add_species(nlohmann::ordered_json& json, const Simulation& simulation);

/// Of a wall: {amplitude, frequency, phase}, {velocity, stop_at} or {tangential}.
nlohmann::ordered_json motion_of(const Scene::WallMotion& motion);

/// Adds "walls", [{axis, side, ...}] since the start, in the order of Scene::wall_sides().
void add_walls(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "energy_budget", with the effects that there are.
void add_energy_budget(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "contacts", where needles may slide on each other.
void add_contacts(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "growth", where bodies grow.
void add_growth(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "pressure_tensor", where it is measured.
void add_stress(nlohmann::ordered_json& json, const Simulation& simulation);

/// Adds "rods", {..., pressure_meaning}, of rods of finite width.
void add_rods(nlohmann::ordered_json& json, const Scene& scene, const Simulation& simulation);

}  // namespace needlework::json
