// The filter of the plain searches: bounding spheres that stay apart in the time ahead. Bodies are
// in theirs, so those do not meet; spheres_stay_apart() has room for what it rounds.
#pragma once

#include "kernels/bounding_spheres.h"
#include "needlework/counters.h"
#include "src/physics/gas.h"
#include "src/search/lengths.h"
#include "src/search/search.h"

namespace needlework {

/// Passes the candidates of a needle on whose bounding spheres may meet in the time ahead.
template <Lengths L>
class BoundingFilter {
 public:
  BoundingFilter(const Gas& gas, Counters& counters, const SearchQuery& query, const L& lengths)
      : gas_(gas),
        counters_(counters),
        lengths_(lengths),
        now_(query.now),
        box_(gas.box_at(now_)),
        ahead_(query.ahead),
        reach_(lengths.reach(query.needle)) {
    const auto motion = gas.motion_from(gas.records[query.needle], now_);
    centre_ = motion.centre();
    v_ = motion.velocity();
  }

  template <class Visit>
  void operator()(Needle j, const Shift& shift, Visit&& visit) {
    ++counters_.candidates;
    const auto other = gas_.motion_from(gas_.records[j], now_);
    const Image<double> image = box_.image(shift);
    const Vec3d r = (centre_ - other.centre()) - image.place;
    const Vec3d v = (v_ - other.velocity()) - image.velocity;
    const double reach = reach_ + lengths_.reach(j);
    if (kernels::spheres_stay_apart(r, v, reach, ahead_)) {
      ++counters_.filtered;
    } else {
      ahead_ = visit(j, shift, 0.0);
    }
  }

  const Vec3d& centre() const { return centre_; }
  const Vec3d& velocity() const { return v_; }
  double ahead() const { return ahead_; }

 private:
  const Gas& gas_;
  Counters& counters_;
  const L& lengths_;
  Time now_;
  Box box_;  ///< now
  double ahead_, reach_;
  Vec3d centre_, v_;
};

}  // namespace needlework
