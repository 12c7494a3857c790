// How dense the gas is where its needles are.
//
// That is what sizes of cells and capsules have to suit, and the search itself (choice.h). Needles
// that fill their box evenly have as many neighbours as its density says; a cloud in a large box,
// or clusters, have more, and that changes as they spread or cool. So needles are counted at first,
// and then counters of the search tell: never clocks, so that a run does the same when it is run
// again. No trajectory depends on it.
#pragma once

#include <cstdint>

#include "src/engine/counters.h"
#include "src/physics/gas.h"

namespace needlework {

class Sizing {
 public:
  explicit Sizing(const Gas& gas);

  /// The density for which sizes are to be chosen. [1 / L^3]
  double density() const { return density_; }
  /// After how many collisions to look again.
  std::uint64_t next() const { return next_; }
  /// Returns whether the density is another one now; then another search counts from now on.
  /// `cell_volume`: of the one that has counted till now. [L^3]
  bool look(std::uint64_t collisions, const Counters& counters, double cell_volume);

 private:
  bool take(double density);

  std::size_t needles_;
  double density_;
  std::uint64_t next_ = 0;
  std::uint64_t searches_ = 0, candidates_ = 0, cells_ = 0;  ///< when it was looked last
};

}  // namespace needlework
