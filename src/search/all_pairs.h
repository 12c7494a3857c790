// Search without a structure: every needle, every image that could come near. The truth that other
// searches are tested against; cost grows with N.
#pragma once

#include <cmath>

#include "src/search/bounding_filter.h"
#include "src/search/setup.h"

namespace needlework {

/// A search proposes, for one needle, the (needle, shift) pairs that it might meet before a time.
/// It may propose too many, never too few.
///
///   Time place(Needle i, Time now)
///     enters i where it is now; called whenever its record has changed, before any search that
///     could meet it, and when the time that this returns has come. Until then i is found where it
///     has been placed.
///   renumber(ranks)
///     needle i has become needle ranks[i]; where they have been placed stays.
///   find(i, now, ahead, visit)
///     calls visit(j, shift, from, to) -> ahead for each (j, shift) that i might meet within the
///     time `ahead` and before j is placed anew: in times from now from `from` to `to`, if at all.
///     shift is added to the centre of j. What visit returns is the time ahead that still matters.
class AllPairs {
 public:
  static constexpr const char* name = "all-pairs";

  AllPairs(const Gas& gas, Counters& counters, const SearchSetup&)
      : gas_(gas), counters_(counters) {}

  Time place(Needle, Time) { return Time::never(); }
  void renumber(const std::vector<Needle>&) {}

  template <class Visit>
  void find(Needle i, Time now, double ahead, Visit&& visit) const {
    const Vec3d& v_i = gas_.records[i].flight.v;
    BoundingFilter filter(gas_, counters_, i, now, ahead);
    for (Needle j = 0; j < gas_.size(); ++j) {
      if (j == i) continue;
      const Record& b = gas_.records[j];
      const Vec3d r = filter.centre() - centre_after(b.flight, gas_.clock.difference(now, b.time));
      const Vec3d v = v_i - b.flight.v;
      const Range x = images(r.x, v.x, filter.ahead(), gas_.box[0]);
      const Range y = images(r.y, v.y, filter.ahead(), gas_.box[1]);
      const Range z = images(r.z, v.z, filter.ahead(), gas_.box[2]);
      for (std::int32_t sx = x.first; sx <= x.last; ++sx) {
        for (std::int32_t sy = y.first; sy <= y.last; ++sy) {
          for (std::int32_t sz = z.first; sz <= z.last; ++sz) {
            filter(j, Shift{sx, sy, sz}, visit);
          }
        }
      }
    }
  }

 private:
  struct Range {
    std::int32_t first, last;
  };
  // The images m for which |r + v s - m box| <= L somewhere in [0, dt], with a margin.
  static Range images(double r, double v, double dt, double box) {
    constexpr double reach = 1 + 0x1p-10;
    const double travel = v == 0 ? 0 : v * dt;
    return {static_cast<std::int32_t>(std::ceil((r + std::fmin(0, travel) - reach) / box)),
            static_cast<std::int32_t>(std::floor((r + std::fmax(0, travel) + reach) / box))};
  }

  const Gas& gas_;
  Counters& counters_;
};

}  // namespace needlework
