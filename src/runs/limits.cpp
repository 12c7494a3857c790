#include "src/runs/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "needlework/error.h"
#include "src/scene/confinement.h"

namespace needlework::runs {
namespace {

// Whether its energy now is a multiple of that at its start, which ends are measured in.
void require_measurable(const std::optional<double>& energy_ratio, const Simulation& simulation) {
  if (!energy_ratio || simulation.initial_energy() != 0 || !(simulation.totals().energy > 0))
    return;
  throw InputError(
      fmt::format("energy_ratio = {}: expected another limit, as the gas was at rest at its start",
                  *energy_ratio));
}

void require_valid(const Limits& limits, const Simulation& simulation) {
  for (const auto& [name, value] :
       {std::pair("time", limits.time),
        std::pair("collisions_per_needle", limits.collisions_per_needle),
        std::pair("energy_ratio", limits.energy_ratio), std::pair("wall_s", limits.wall_s)}) {
    if (value && !(*value >= 0)) {
      throw InputError(fmt::format("{} = {}: expected a number >= 0", name, *value));
    }
  }
  require_measurable(limits.energy_ratio, simulation);
  if (limits.empty()) {
    throw InputError(
        "no end condition: expected one or more of time, collisions, collisions_per_needle, "
        "energy_ratio, wall_s");
  }
}

/// Adds the limit on the number of collisions of all needles since the start, where the gas has
/// `needles`. It is set half a collision lower, so that rounding cannot ask for one more.
void add_collisions(Scene::Until& until, double collisions, double needles) {
  // Without needles nothing can happen.
  const double per_needle = needles > 0 ? 2 * std::max(0.0, collisions - 0.5) / needles : 0;
  until.collisions_per_needle =
      std::min(per_needle, until.collisions_per_needle.value_or(per_needle));
}

}  // namespace

Scene::Until from_start(const Limits& limits, const Simulation& simulation) {
  require_valid(limits, simulation);
  Scene::Until until{.time = limits.time,
                     .collisions_per_needle = limits.collisions_per_needle,
                     .energy_ratio = limits.energy_ratio,
                     .wall_s = limits.wall_s};
  if (limits.collisions) {
    add_collisions(until, static_cast<double>(*limits.collisions),
                   static_cast<double>(simulation.needles()));
  }
  return until;
}

Scene::Until from_start_or_scene(const Limits& limits, const Scene& scene,
                                 const Simulation& simulation) {
  if (!limits.empty() || !has_end(scene)) return from_start(limits, simulation);
  require_measurable(scene.until.energy_ratio, simulation);
  return scene.until;
}

Scene::Until from_now(const Limits& limits, const Simulation& simulation) {
  require_valid(limits, simulation);
  Scene::Until until{
      .time = {}, .collisions_per_needle = {}, .energy_ratio = {}, .wall_s = limits.wall_s};
  const auto needles = static_cast<double>(simulation.needles());
  const auto done = static_cast<double>(simulation.collisions());
  if (limits.time) until.time = simulation.time() + *limits.time;
  if (limits.collisions_per_needle) {
    add_collisions(until, done + std::ceil(*limits.collisions_per_needle * needles / 2), needles);
  }
  if (limits.collisions) {
    add_collisions(until, done + static_cast<double>(*limits.collisions), needles);
  }
  if (limits.energy_ratio) {
    const double ratio = *limits.energy_ratio, initial = simulation.initial_energy(),
                 energy = simulation.totals().energy;
    // One that is met already has to be met in spite of rounding, and be a number for gases at
    // rest.
    constexpr double largest = std::numeric_limits<double>::max();
    until.energy_ratio = ratio >= 1 ? largest : initial > 0 ? ratio * (energy / initial) : ratio;
  }
  return until;
}

}  // namespace needlework::runs
