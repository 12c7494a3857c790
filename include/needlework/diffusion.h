// Diffusion of elastic needles in equilibrium by kinetic theory. Units: L = m = 1.
#pragma once

namespace needlework::theory {

/// How fast smooth elastic needles in equilibrium forget their velocities, and how they diffuse if
/// successive collisions are not correlated.
struct Transport {
  /// -d ln C / dt at t = 0 of C(t) = <v(0).v(t)>, and of C(t) = <w(0).w(t)>. Exact at every
  /// density. [1 / time]
  double velocity_decay = 0, angular_velocity_decay = 0;
  /// (T/m) / velocity_decay, of a centre along any axis [L^2 / time], and (T/I) /
  /// angular_velocity_decay, of the director [1 / time]: if both decay exponentially. Infinite
  /// without collisions.
  double diffusion = 0, rotational_diffusion = 0;
};

/// At number density `density` [L^-3] and temperature T > 0. Pure, so that threads may call it
/// freely. Throws std::invalid_argument, "NAME = VALUE: expected ...", for a number out of range.
Transport uncorrelated_transport(double density, double temperature, double k);

}  // namespace needlework::theory
