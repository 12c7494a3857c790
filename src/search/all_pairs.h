// Search without a structure: every needle, every image that could come near. The truth that other
// searches are tested against; cost grows with N.
#pragma once

#include <cmath>

#include "src/physics/gas.h"

namespace needlework {

/// A search proposes, for one needle, the (needle, shift) pairs that it might meet before a time.
/// It may propose too many, never too few.
class AllPairs {
 public:
  static constexpr const char* name = "all-pairs";

  explicit AllPairs(const Gas& gas) : gas_(gas) {}

  void insert(Needle, Time) {}
  /// The candidates proposed for i are complete at least until this time.
  Time complete_until(Needle, Time) const { return Time::never(); }
  /// Takes the step that this time asks for, if it has come; says whether.
  bool move_on(Needle, Time) { return false; }
  /// Called when a record has been wrapped.
  void rewrap(Needle, const Shift&) {}

  /// Calls visit(j, shift) for each candidate of i; shift is added to the centre of j.
  template <class Visit>
  void for_each_candidate(Needle i, Time now, Time until, Visit&& visit) const {
    const Record& a = gas_.records[i];
    const double dt = gas_.clock.difference(until, now);
    const Vec3d ra = centre_after(a.flight, gas_.clock.difference(now, a.time));
    for (Needle j = 0; j < gas_.size(); ++j) {
      if (j == i) continue;
      const Record& b = gas_.records[j];
      const Vec3d r = ra - centre_after(b.flight, gas_.clock.difference(now, b.time));
      const Vec3d v = a.flight.v - b.flight.v;
      const Range x = images(r.x, v.x, dt, gas_.box[0]);
      const Range y = images(r.y, v.y, dt, gas_.box[1]);
      const Range z = images(r.z, v.z, dt, gas_.box[2]);
      for (std::int32_t sx = x.first; sx <= x.last; ++sx) {
        for (std::int32_t sy = y.first; sy <= y.last; ++sy) {
          for (std::int32_t sz = z.first; sz <= z.last; ++sz) visit(j, Shift{sx, sy, sz});
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
};

}  // namespace needlework
