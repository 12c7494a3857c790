// The mean free time, by which windows and the relative contact time are measured.
#pragma once

namespace needlework {

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

}  // namespace needlework
