// The mean free time that windows and the contact time are measured in.
#pragma once

namespace needlework {

/// Mean time between two collisions of a needle, for Gaussian velocities at these temperatures:
/// 1 / (n (sqrt(pi)/2) integral over the unit square of sqrt(T_tr + T_rot k r^2)), within 1e-6;
/// infinite when nothing moves. `density` in L^-3.
/// Trajectories depend on it by way of the t_c rule, so it uses nothing but + * / and square roots,
/// which are the same bits everywhere; theory::collision_rate is the accurate one.
double mean_free_time(double density, double t_tr, double t_rot, double k);

}  // namespace needlework
