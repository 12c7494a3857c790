// Why a simulation stopped.
#pragma once

namespace needlework {

/// Why Simulation::advance() returned.
enum class Stop { time, collisions, energy, wall_time, interrupted, nothing_can_happen };

}  // namespace needlework
