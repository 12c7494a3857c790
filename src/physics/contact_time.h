// The t_c rule: a collision is elastic if one of its needles has collided a short time before.
#pragma once

#include "src/physics/columns.h"
#include "src/physics/gas.h"

namespace needlework {

/// The rule keeps the time of each needle's last collision. Renewals of records do not count.
class ContactTimeRule {
 public:
  /// Adds its column to the gas, in which every needle has collided infinitely long ago.
  explicit ContactTimeRule(Gas& gas)
      : clock_(&gas.clock), last_collision_(&gas.columns.add<Time>("last_collision", long_ago)) {}

  /// Whether less than the contact time has passed since the last collision of needle i.
  bool is_recent(Needle i, Time now, double contact_time) const {
    return clock_->difference(now, (*last_collision_)[i]) < contact_time;
  }
  void collided(Needle i, Time now) const { (*last_collision_)[i] = now; }
  const LargeArray<Time>& last_collisions() const { return last_collision_->values(); }

  static constexpr Time long_ago{-(std::int64_t{1} << 62), 0};

 private:
  const Clock* clock_;
  Column<Time>* last_collision_;
};

}  // namespace needlework
