// Why a simulation stopped.
#pragma once

namespace needlework {

/// Why Simulation::advance() returned.
enum class Stop { time, collisions, energy, wall_time, interrupted, nothing_can_happen };

/// Its name, as enumerated.
constexpr const char* name_of(Stop stop) {
  switch (stop) {
    case Stop::time:
      return "time";
    case Stop::collisions:
      return "collisions";
    case Stop::energy:
      return "energy";
    case Stop::wall_time:
      return "wall_time";
    case Stop::interrupted:
      return "interrupted";
    case Stop::nothing_can_happen:
      break;
  }
  return "nothing_can_happen";
}

}  // namespace needlework
