// Needles that collide with each other as the Boltzmann equation says. They have velocities, but no
// places, and of the directors of those that rotate only that they are normal to the angular
// velocities; those that do not rotate keep theirs, and collide the less the more they fly along
// them.
#pragma once

#include <cstdint>
#include <vector>

#include "needlework/boltzmann.h"
#include "src/boltzmann/encounter.h"
#include "src/boltzmann/sums.h"
#include "src/random/needle_random.h"

namespace needlework::boltzmann {

class Pool {
 public:
  /// Number `number` of the pools of these settings, of so many needles.
  Pool(const Settings& settings, std::uint64_t number, std::size_t needles);

  /// Collisions until tau, which must not be before that of the last call.
  void advance(double tau);

  /// Sums over all needles, so that those of several pools can be added.
  Sums sums() const;
  /// Adds its counts.
  void add_to(Result& result) const;

 private:
  struct Needle {
    Vec3d v, w;
    Vec3d u;             ///< while w = 0
    double fastest = 0;  ///< of its points, not below [L / time]
  };
  void set_fastest(Needle& needle);
  void find_fastest();
  Vec3d director(const Needle& needle);
  void meet(Needle& a, Needle& b, const Touching& pair);

  Settings settings_;
  NeedleRandom random_;
  std::vector<Needle> needles_;
  double fastest_ = 0;  ///< of all needles, not below
  double time_ = 0;     ///< n t
  std::uint64_t collisions_ = 0, tc_collisions_ = 0, met_before_ = 0, unfinished_ = 0;
  std::uint64_t until_looked_ = 0;  ///< collisions until the fastest needle is looked for again
  double t_tr_ = 0;                 ///< when it was last looked for
  std::vector<std::uint64_t> encounters_of_;
};

}  // namespace needlework::boltzmann
