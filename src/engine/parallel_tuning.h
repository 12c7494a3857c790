// Settings of the loop of several threads.
#pragma once

#include <string_view>

#include "src/engine/phase_plan.h"

namespace needlework {

/// How far threads look and how much work they share. Values other than the defaults are for
/// tests.
struct ParallelTuning {
  /// Distance from its needles within which an event looks for earlier ones, besides the distance
  /// that needles may be outside of their cells. If it is shorter, phases are rolled back
  /// repeatedly; if it is longer, events wait without need. [L]
  double sight = 1.6;
  double least = PhasePlan::usual_least;  ///< least number of collisions for which a phase is
                                          ///< shared
  bool by_cost = true;                    ///< whether one thread works alone where that is faster
  std::string_view place = "engine.threads";  ///< who asked for threads, for messages of the
                                              ///< constructor
};

}  // namespace needlework
