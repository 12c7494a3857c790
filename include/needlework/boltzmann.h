// Direct simulation of the Boltzmann equation of hard needles: what the engine would find if
// partners were never correlated. Beside kinetic theory it shows what velocities do that do not
// stay Gaussian, and beside the engine what collisions of the same pair do, in the limit of low
// density.
//
// Needles are drawn from a pool in pairs, with a phase of rotation and arms at random, and collide
// with the rate |u1 x u2| |V_n| of the equation (no time step: candidates come as a Poisson process
// of a higher rate and are thinned out). Units: L = m = 1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "needlework/theory.h"

namespace needlework::boltzmann {

/// What happens to a pair that has been drawn.
enum class Pairs {
  single,     ///< one collision
  encounters  ///< if it has not met before, all collisions until it has parted for good
};

struct Settings {
  theory::Gas gas;
  theory::Temperatures initial;  ///< of Gaussian velocities; T_tr > 0
  Pairs pairs = Pairs::single;
  /// The t_c rule for later collisions of an encounter: elastic and smooth if less than this time
  /// has passed since the one before. In units of L (m / T_tr)^1/2 of that moment. Must be above 0
  /// in an inelastic gas, or encounters that collapse would never end.
  double contact_time = 1e-3;
  std::uint64_t needles = 32000;  ///< of all pools together, at least 64
  std::uint64_t seed = 1;
};

/// Of all needles together, with the standard error that independent pools of them show.
struct Measured {
  double value = 0, error = 0;
};

/// What is measured at a time.
struct Sample {
  double tau = 0;  ///< (2/3) sqrt(pi) n t
  Measured t_tr, t_rot, energy;
  Measured collisions;  ///< per needle, since the start
  /// <v^4> / (15 T_tr^2) - 1, <w^4> / (2 <w^2>^2) - 1 and <v^2 w^2> / (<v^2> <w^2>) - 1: 0 for
  /// Gaussian velocities. NaN where a temperature is 0. [1]
  Measured excess_tr, excess_rot, excess_mixed;
};

struct Result {
  std::vector<Sample> samples;  ///< at the times asked for
  std::uint64_t encounters = 0;
  std::uint64_t met_before = 0;  ///< pairs left out, as an earlier collision would have been first
  std::uint64_t tc_collisions = 0;  ///< by the t_c rule
  std::uint64_t unfinished = 0;     ///< encounters given up after very many collisions or steps
  /// Encounters of one collision, of two and so on; the last counts all longer ones.
  std::vector<std::uint64_t> encounters_of;
};

/// The temperatures at each of the times `taus` (finite, >= 0, in ascending order). Depends on the
/// settings alone, not on the number of threads. Throws std::invalid_argument, "NAME = VALUE:
/// expected ...", for a number out of range.
Result simulate(const Settings& settings, std::span<const double> taus, int threads = 1);

}  // namespace needlework::boltzmann
