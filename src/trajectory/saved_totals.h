// Totals as part of a checkpoint, or on their way from another process.
#pragma once

#include "needlework/totals.h"
#include "src/archive/archive.h"

namespace needlework {

inline void transfer(Archive& archive, Totals& totals) {
  auto& [time, t_tr, t_rot, energy, momentum, collisions, tc_collisions] = totals;
  archive(time, t_tr, t_rot, energy, momentum, collisions, tc_collisions);
}

}  // namespace needlework
