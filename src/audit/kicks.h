// Kicks of all needles at one instant, with random numbers that the audit computes itself.
#pragma once

#include <cstdint>

#include "needlework/scene.h"
#include "src/audit/pair_flight.h"

namespace needlework::audit {

/// What kicks do to needles, in the units of the audit: a function of the seed of the scene, the
/// needle's id and the number of the kick.
class Kicks {
 public:
  Kicks(const Scene::Kicks& kicks, std::uint64_t seed, double epoch_length, double unit);

  struct Change {
    Vector<Quad> v;  ///< before the momentum of all is taken off
    Vector<Quad> w;  ///< of which the part along the director does not count
    /// By how much components are off as the squares of a point next to the circle are rounded.
    double v_off = 0, w_off = 0;
  };
  Change of(std::uint32_t id, std::uint64_t kick) const;

 private:
  std::uint64_t seed_;
  Quad translational_, rotational_;  ///< standard deviations of components
};

/// Largest difference of a needle's record after a kick from what the kick makes of it, in units of
/// what rounding may explain; a value above 1 is an error. `of_all` holds the velocity that is
/// taken off all needles, and `largest` is at least the size of each change of a velocity.
double excess_over_kick(const Needle& before, const Vector<double>& gravity, const Record& after,
                        const Kicks::Change& change, const Kicks::Change& of_all, double largest,
                        const Space& space);

}  // namespace needlework::audit
