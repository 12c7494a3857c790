// Needles that collide with each other as the Boltzmann equation says. They have velocities, but no
// places, and of the directors of those that rotate only that they are normal to the angular
// velocities; those that do not rotate keep theirs, and collide the less the more they fly along
// them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "needlework/boltzmann.h"
#include "src/boltzmann/encounter.h"
#include "src/boltzmann/sums.h"
#include "src/random/needle_random.h"

namespace needlework::boltzmann {

class Pool {
 public:
  /// Number `number` of the pools of these settings, with so many needles of each species.
  Pool(const Settings& settings, std::uint64_t number, std::span<const std::uint64_t> needles);

  /// Collisions until tau, which must not be before that of the last call.
  void advance(double tau);

  /// Over the needles of each species, so that those of several pools can be added.
  std::vector<Sums> sums() const;
  /// Of each two species so far, by Composition::pair_index.
  std::vector<std::uint64_t> collisions_between() const;
  /// Adds its counts.
  void add_to(Result& result) const;

 private:
  struct Needle {
    Vec3d v, w;
    Vec3d u;             ///< while w = 0
    double fastest = 0;  ///< of its points, not below [L / time]
  };
  /// A species, whose needles stand in a row.
  struct Kind {
    double mass, inertia;  ///< [m], [m L^2]
    Body body;
    std::size_t first, count;
    double fastest = 0;            ///< of its needles, not below [L / time]
    std::uint64_t collisions = 0;  ///< that its needles have taken part in
  };
  /// Two species, or one twice.
  struct Partners {
    std::size_t first, second;
    Restitution rule;
    double weight;  ///< pairs that meet over all needles, times both lengths [L^2]
    std::uint64_t collisions = 0;
  };
  std::span<Needle> needles_of(const Kind& kind);
  std::span<const Needle> needles_of(const Kind& kind) const;
  void draw(Kind& kind, const Species& species);
  void set_fastest(Needle& needle, Kind& kind);
  void find_fastest();
  double candidates(const Partners& partners) const;
  Partners& any_partners(double all);
  std::size_t any_of(std::size_t count);
  Vec3d director(const Needle& needle);
  void meet(Partners& partners, Needle& a, Needle& b, const Touching& pair);

  Pairs pairs_;
  double contact_time_;
  NeedleRandom random_;
  std::vector<Kind> kinds_;
  std::vector<Partners> partners_;  ///< by Composition::pair_index
  std::vector<Needle> needles_;
  double time_ = 0;  ///< n t
  std::uint64_t tc_collisions_ = 0, met_before_ = 0, unfinished_ = 0;
  std::uint64_t until_looked_ = 0;  ///< collisions until the fastest needles are looked for again
  double t_tr_ = 0;                 ///< of all needles, when they were last looked for
  std::vector<std::uint64_t> encounters_of_;
};

}  // namespace needlework::boltzmann
