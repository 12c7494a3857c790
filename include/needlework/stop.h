// Why a simulation stopped.
#pragma once

namespace needlework {

/// Why Simulation::advance() returned.
enum class Stop {
  time,
  collisions,
  energy,
  wall_time,
  interrupted,
  nothing_can_happen,
  walls_meet,  ///< walls with a velocity leave the longest body no more room
  jammed,      ///< they, or growth, press bodies together, which collide ever more often in no time
  grown,       ///< bodies have grown to the packing fraction of driving.growth
  pressure,    ///< their pressure has come to that of driving.growth
  no_room      ///< an edge of the box leaves bodies that grow no more room
};

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
    case Stop::walls_meet:
      return "walls_meet";
    case Stop::jammed:
      return "jammed";
    case Stop::grown:
      return "grown";
    case Stop::pressure:
      return "pressure";
    case Stop::no_room:
      return "no_room";
    case Stop::nothing_can_happen:
      break;
  }
  return "nothing_can_happen";
}

}  // namespace needlework
