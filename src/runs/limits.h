// When an advance ends, as front ends ask for it: counted from the start or from the present.
#pragma once

#include <cstdint>
#include <optional>

#include "needlework/scene.h"
#include "needlework/simulation.h"

namespace needlework::runs {

/// Conditions of which the first one met ends an advance.
struct Limits {
  std::optional<double> time = {};                   ///< [time]
  std::optional<std::uint64_t> collisions = {};      ///< of all needles together
  std::optional<double> collisions_per_needle = {};  ///< 2 collisions / N
  std::optional<double> energy_ratio = {};  ///< energy over that at the start or at present
  std::optional<double> wall_s = {};        ///< wall-clock time, always from now on [s]

  /// Whether none is set.
  bool empty() const {
    return !time && !collisions && !collisions_per_needle && !energy_ratio && !wall_s;
  }
};

/// The same conditions as the engine takes them, counted from the start of the run. Throws
/// InputError, "NAME = VALUE: expected ...", if none is set, or one is negative or not a number.
Scene::Until from_start(const Limits& limits, const Simulation& simulation);
/// The same; where no limit is given, the ends that the scene sets.
Scene::Until from_start_or_scene(const Limits& limits, const Scene& scene,
                                 const Simulation& simulation);
/// The same, for conditions that count from the present state of the simulation.
Scene::Until from_now(const Limits& limits, const Simulation& simulation);

}  // namespace needlework::runs
