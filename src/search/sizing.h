// How dense the gas is where its needles are.
//
// The sizes of cells and capsules depend on this density, and so does the choice of the search
// (choice.h). Needles that fill their box evenly have as many neighbours as the mean density says.
// Needles in a cloud in a large box, or in clusters, have more, and their number changes as they
// spread or cool. So needles are counted, at the start and then every few collisions: by where they
// are and by no clock, so that a run does the same when it is repeated. No trajectory depends on
// it.
#pragma once

#include <cstdint>

#include "src/physics/gas.h"

namespace needlework {

class Sizing {
 public:
  Sizing(const Gas& gas, Time now);

  /// The density for which sizes are to be chosen: needles per cube of the longest one.
  double density() const { return density_; }
  /// The number of collisions after which to call look() again.
  std::uint64_t next() const { return next_; }
  /// Counts the needles, and returns whether the density has changed by enough to matter.
  bool look(std::uint64_t collisions, const Gas& gas, Time now);

 private:
  double density_, last_count_ = 0;
  std::uint64_t apart_ = 0;  ///< collisions per needle from the last count to the next
  std::uint64_t next_ = 0;
};

}  // namespace needlework
