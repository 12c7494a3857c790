// Totals as part of a checkpoint, or on their way from another process.
#pragma once

#include <algorithm>
#include <cmath>

#include "needlework/totals.h"
#include "src/archive/archive.h"

namespace needlework {

inline void transfer(Archive& archive, Totals& totals) {
  Totals::for_each_member([&](const Described&, auto member) { archive(totals.*member); });
}

inline void transfer(Archive& archive, WallTotals& wall) {
  archive(wall.axis, wall.high, wall.hits, wall.impulse, wall.normal_impulse, wall.area, wall.phase,
          wall.energy, wall.pressure, wall.place, wall.work, wall.impulse_x, wall.impulse_y,
          wall.impulse_z);
}

/// Whether these can be the totals of a gas of which this share turns, as far as can be seen from
/// them alone. `falls`: their energy is not that of motion alone, as there is gravity.
inline bool are_possible(const Totals& totals, double turning, bool falls) {
  const auto is_amount = [](double x) { return std::isfinite(x) && x >= 0; };
  const auto is_finite = [](double x) { return std::isfinite(x); };
  return is_amount(totals.time) && is_amount(totals.t_tr) && is_amount(totals.t_rot) &&
         (falls ? is_finite(totals.energy)
                : totals.energy == 1.5 * totals.t_tr + turning * totals.t_rot) &&
         std::ranges::all_of(totals.momentum, is_finite) &&
         totals.tc_collisions <= totals.collisions;
}

}  // namespace needlework
