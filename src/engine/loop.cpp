#include "src/engine/loop.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "needlework/error.h"
#include "src/engine/present_state.h"

namespace needlework {

StopConditions::StopConditions(const Run& run, const Scene::Until& until)
    : time(until.time ? run.gas.clock.add({}, std::max(0.0, *until.time)) : Time::never()),
      collisions(until.collisions_per_needle
                     ? *until.collisions_per_needle * static_cast<double>(run.gas.size()) / 2
                     : std::numeric_limits<double>::infinity()),
      energy(until.energy_ratio ? *until.energy_ratio * run.initial_energy
                                : -std::numeric_limits<double>::infinity()),
      wall(std::chrono::steady_clock::time_point::max()) {
  if (run.last_time < time) {
    time = run.last_time;
    why = run.at_last_time;
  }
  if (!run.growing && !until.time && !until.collisions_per_needle && !until.energy_ratio &&
      !until.wall_s) {
    throw InputError("until: expected at least one end condition");
  }
  for (const auto& [name, end] : {std::pair("time", until.time),
                                  {"collisions_per_needle", until.collisions_per_needle},
                                  {"energy_ratio", until.energy_ratio},
                                  {"wall_s", until.wall_s}}) {
    if (end && std::isnan(*end)) {
      throw InputError(std::string("until.") + name + " = nan: expected a number");
    }
  }
  if (until.energy_ratio && !(run.gas.pull == Vec3d{})) {
    throw InputError(
        "until.energy_ratio: expected another end under gravity along a periodic axis, which does "
        "work all the time");
  }
  if (until.wall_s) {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> left(*until.wall_s);
    if (left < wall - now) {
      wall = now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(left);
    }
  }
}

std::optional<Stop> StopConditions::reached_without_events(Run& run) const {
  if (time < run.now) return why;
  if (time == Time::never()) {
    if (run.collisionless()) return Stop::nothing_can_happen;
    // Sources may have events for ever, but no collision.
    const bool none_meet = run.gas.size() < 2 || !run.gas.composition.any_meet();
    if (none_meet && energy < 0 && wall == wall.max()) return Stop::nothing_can_happen;
    return std::nullopt;
  }
  if (!run.nothing_can_happen()) return std::nullopt;
  require_images(run.gas, time);
  run.now = time;
  return why;
}

std::optional<Stop> StopConditions::called_off(Run& run) const {
  if (run.interrupted) return Stop::interrupted;
  if (wall != wall.max() && std::chrono::steady_clock::now() >= wall) return Stop::wall_time;
  if (time == Time::never() && run.is_quiet()) return Stop::nothing_can_happen;
  return std::nullopt;
}

}  // namespace needlework
