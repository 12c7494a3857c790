// Needles whose records are renewed where their flights have led.
#pragma once

#include "src/physics/gas.h"

namespace needlework::test {

struct Velocities {
  Vec3d v, w;
};

/// Gives needle i another director and other velocities at `now`. Returns as renew_record().
inline Shift renew_in_flight(Gas& gas, Needle i, Time now, const Vec3d& director,
                             const Velocities& velocities = {}) {
  return renew_record(gas, i, now, {gas.present(i, now).r, velocities.v, director, velocities.w},
                      gas.body(i));
}

}  // namespace needlework::test
