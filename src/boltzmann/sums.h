// Sums over needles of a simulation, and what is measured of them.
#pragma once

#include <span>

#include "needlework/boltzmann.h"

namespace needlework::boltzmann {

/// Over the needles of one pool or of several, with v^2, w^2 and so on of each.
struct Sums {
  double needles = 0, collisions = 0;
  double v2 = 0, w2 = 0, v4 = 0, w4 = 0, v2w2 = 0;

  Sums& operator+=(const Sums& other);
};

/// All that a sample has, but for its tau, of the sums of independent pools, at least two. Each
/// number is that of the sums over all pools: a ratio of them, such as an excess, is biased by one
/// over the number of all needles, and a mean of the ratios of pools would be by one over that of a
/// pool. Errors come from leaving out one pool at a time (jackknife), which for a mean over equal
/// pools is its standard error.
Sample measured(std::span<const Sums> pools, double k);

}  // namespace needlework::boltzmann
