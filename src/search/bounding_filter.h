// The first filter of the plain searches: bounding spheres that stay apart.
#pragma once

#include <limits>

#include "kernels/bounding_spheres.h"
#include "needlework/counters.h"
#include "src/physics/gas.h"
#include "src/search/lengths.h"

namespace needlework {

/// Passes the candidates of needle i on whose bounding spheres may meet in the time ahead.
class BoundingFilter {
 public:
  BoundingFilter(const Gas& gas, Counters& counters, Needle i, Time now, double ahead)
      : gas_(gas),
        counters_(counters),
        now_(now),
        ahead_(ahead),
        half_(half_length_of(gas, i)),
        v_(gas.records[i].flight.v) {
    const Record& record = gas.records[i];
    centre_ = centre_after(record.flight, gas.clock.difference(now, record.time));
  }

  template <class Visit>
  void operator()(Needle j, const Shift& shift, Visit&& visit) {
    ++counters_.candidates;
    const Record& other = gas_.records[j];
    const Vec3d image{shift[0] * gas_.box[0], shift[1] * gas_.box[1], shift[2] * gas_.box[2]};
    const Vec3d r =
        (centre_ - centre_after(other.flight, gas_.clock.difference(now_, other.time))) - image;
    const double reach = half_ + half_length_of(gas_, j);
    if (kernels::spheres_stay_apart(r, v_ - other.flight.v, reach, ahead_)) {
      ++counters_.filtered;
    } else {
      ahead_ = visit(j, shift, 0.0, std::numeric_limits<double>::infinity());
    }
  }

  const Vec3d& centre() const { return centre_; }
  double ahead() const { return ahead_; }

 private:
  const Gas& gas_;
  Counters& counters_;
  Time now_;
  double ahead_, half_;
  Vec3d centre_, v_;
};

}  // namespace needlework
