// Sums over needles of a simulation, and what is measured of them.
#pragma once

#include <span>

#include "needlework/boltzmann.h"

namespace needlework::boltzmann {

/// Over needles of one pool or of several.
struct Sums {
  double needles = 0;
  double collisions = 0;  ///< that each has taken part in
  /// m v^2, I w^2, their squares and their product.
  double tr = 0, rot = 0, tr_tr = 0, rot_rot = 0, tr_rot = 0;

  Sums& operator+=(const Sums& other);
};

/// The means that the sums of independent pools give, at least two. Each number is that of the sums
/// over all pools: a ratio of them, such as an excess, is biased by one over the number of all
/// needles, and a mean of the ratios of pools would be by one over that of a pool. Errors come from
/// leaving out one pool at a time (jackknife), which for a mean over equal pools is its standard
/// error.
Means measured(std::span<const Sums> pools);

}  // namespace needlework::boltzmann
