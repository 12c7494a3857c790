// Direct simulation of the Boltzmann equation of hard needles: what the engine would find if
// partners were never correlated. Beside kinetic theory it shows what velocities do that do not
// stay Gaussian, and beside the engine what collisions of the same pair do, in the limit of low
// density.
//
// Needles are drawn from a pool in pairs, with a phase of rotation and arms at random, and collide
// with the rate |u1 x u2| |V_n| of the equation (no time step: candidates come as a Poisson process
// of a higher rate and are thinned out). In a mixture each two species meet at a rate of their own.
// Units: those of the composition, in which k_B = 1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "needlework/composition.h"
#include "needlework/theory.h"

namespace needlework::boltzmann {

/// What happens to a pair that has been drawn.
enum class Pairs {
  single,     ///< one collision
  encounters  ///< if it has not met before, all collisions until it has parted for good
};

/// A gas of one species of length 1 and mass 1 with these temperatures.
Composition one_species(const theory::Gas& gas, const theory::Temperatures& initial = {});

struct Settings {
  /// Thin needles. The counts of species say what share of the needles each has, their temperatures
  /// are those of Gaussian velocities at the start; T_tr of all needles must be above 0.
  Composition composition = one_species({});
  Pairs pairs = Pairs::single;
  /// The t_c rule for later collisions of an encounter: elastic and smooth if less than this time
  /// has passed since the one before. In units of L (m / T_tr)^1/2 of that moment, with the L and m
  /// of the units and T_tr of all needles. Must be above 0 in an inelastic gas, or encounters that
  /// collapse would never end.
  double contact_time = 1e-3;
  std::uint64_t needles = 32000;  ///< of all pools together, at least 64 of each species
  std::uint64_t seed = 1;
};

/// Of all needles together, with the standard error that independent pools of them show.
struct Measured {
  double value = 0, error = 0;
};

/// Means over some needles.
struct Means {
  Measured t_tr, t_rot, energy;
  Measured collisions;  ///< per needle, since the start
  /// <v^4> / (15 T_tr^2) - 1, <w^4> / (2 <w^2>^2) - 1 and <v^2 w^2> / (<v^2> <w^2>) - 1, with m v^2
  /// and I w^2 in place of v^2 and w^2 where needles are unlike: 0 for Gaussian velocities of equal
  /// temperatures. NaN where a temperature is 0. [1]
  Measured excess_tr, excess_rot, excess_mixed;
};

/// What is measured at a time, of all needles together.
struct Sample : Means {
  double tau = 0;              ///< (2/3) sqrt(pi) n t, with n the density of all needles [L^-3]
  std::vector<Means> species;  ///< NaN where a species has no needles
  /// Of each two species since the start, over the number of all needles, by
  /// Composition::pair_index.
  std::vector<Measured> collisions_between;
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
/// expected ...", in a mixture after the name of the species, for a number out of range.
Result simulate(const Settings& settings, std::span<const double> taus, int threads = 1);

}  // namespace needlework::boltzmann
