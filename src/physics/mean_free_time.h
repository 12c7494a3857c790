// The mean free time, by which windows and the relative contact time are measured.
#pragma once

#include <span>

#include "needlework/composition.h"

namespace needlework {

/// The temperatures of one species.
struct SpeciesTemperatures {
  double t_tr = 0, t_rot = 0;
};

/// A gas of one species with Gaussian velocities.
struct ThermalGas {
  double density = 0;  ///< needles per volume [L^-3]
  double t_tr = 0, t_rot = 0;
  double length = 1;  ///< [L]
  double mass = 1;    ///< [m]
  double k = 6;       ///< m L^2 / (2 I)
};

/// Mean time between two collisions of a needle, 1 / (n L^2 (sqrt(pi) / 2) integral over the unit
/// square of sqrt((T_tr + T_rot k r^2) / m)), within 1e-6 relative. It is infinite when nothing
/// moves. Trajectories depend on it through the t_c rule, so it uses only + * / and square roots,
/// whose results are the same on all machines. theory::collision_rate is more accurate.
double mean_free_time(const ThermalGas& gas);

/// The same for a mixture, or for rods, in this volume [L^3]: the mean time between two collisions
/// of a needle, averaged over all needles that move. Needles of one species give what that gives
/// for them in several. A species has Gaussian velocities with temperatures of its own. Species a
/// and b collide n_a n_b sqrt(pi / 8) L_a L_b <sigma> times per volume and time, with sigma^2 =
/// T_tr,a / m_a + T_tr,b / m_b + T_rot,a s^2 / I_a + T_rot,b s'^2 / I_b averaged over s and s'
/// along the needles; rods of finite width collide more often by their caps, and in dense gases,
/// which this does not count; see docs/physics.md.
double mean_free_time(const Composition& composition, double volume,
                      std::span<const SpeciesTemperatures> temperatures);

}  // namespace needlework
