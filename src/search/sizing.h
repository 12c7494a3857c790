// How dense the gas is where its needles are.
//
// That is what sizes of cells and capsules have to suit, and the search itself (choice.h). Needles
// that fill their box evenly have as many neighbours as its density says; a cloud in a large box,
// or clusters, have more, and that changes as they spread or cool. So needles are counted, at the
// start and then every few collisions: by where they are and by no clock, so that a run does the
// same when it is run again. No trajectory depends on it.
#pragma once

#include <cstdint>

#include "src/physics/gas.h"

namespace needlework {

class Sizing {
 public:
  Sizing(const Gas& gas, Time now);

  /// The density for which sizes are to be chosen. [1 / L^3]
  double density() const { return density_; }
  /// After how many collisions to look again.
  std::uint64_t next() const { return next_; }
  /// Returns whether the density is another one now.
  bool look(std::uint64_t collisions, const Gas& gas, Time now);

 private:
  double density_;
  std::uint64_t next_ = 0;
};

}  // namespace needlework
