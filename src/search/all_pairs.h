// Search without a structure: every needle, every image that could come near. Other searches are
// tested against it. Its cost grows with the number of needles.
#pragma once

#include <cmath>

#include "src/search/bounding_filter.h"
#include "src/search/search.h"
#include "src/search/setup.h"

namespace needlework {

/// Every needle and image that could come near.
class AllPairs {
 public:
  static constexpr const char* search_name = "all-pairs";

  AllPairs(const Gas& gas, Counters& counters, const SearchSetup&)
      : gas_(gas), counters_(counters) {}

  const char* name() const { return search_name; }
  std::size_t cells() const { return 1; }
  std::uint32_t cell_index(Needle) const { return 0; }
  void prefetch(Needle) const {}
  Time place(Needle, Time, double /*half_length*/) { return Time::never(); }
  void set_next_event(Needle, Time) {}
  Time next_event(Needle) const { return Time::never(); }
  void begin_again(Time) {}
  void renumber(const std::vector<Needle>&) {}

  template <class Visit>
  void find(const SearchQuery& query, const Lengths auto& lengths, Visit&& visit) const {
    const Needle i = query.needle;
    BoundingFilter filter(gas_, counters_, query, lengths);
    for (Needle j{0}; j < gas_.size(); ++j) {
      if (j == i) continue;
      const auto other = gas_.motion_from(gas_.records[j], query.now);
      const Vec3d r = filter.centre() - other.centre(), v = filter.velocity() - other.velocity();
      const double reach = lengths.reach(i) + lengths.reach(j);
      const Range x = images(r.x, v.x, reach, filter.ahead(), 0);
      const Range y = images(r.y, v.y, reach, filter.ahead(), 1);
      const Range z = images(r.z, v.z, reach, filter.ahead(), 2);
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
  // The images m for which |r + v s - m box| <= reach somewhere in [0, dt], with a margin.
  Range images(double r, double v, double reach, double dt, int axis) const {
    if (gas_.walled[axis]) return {0, 0};
    const double box = gas_.box[axis];
    const double wide = reach * (1 + 0x1p-10), travel = v == 0 ? 0 : v * dt;
    return {static_cast<std::int32_t>(std::ceil((r + std::fmin(0, travel) - wide) / box)),
            static_cast<std::int32_t>(std::floor((r + std::fmax(0, travel) + wide) / box))};
  }

  const Gas& gas_;
  Counters& counters_;
};

static_assert(Search<AllPairs>);

}  // namespace needlework
