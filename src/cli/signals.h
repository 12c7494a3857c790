// SIGINT, SIGTERM and SIGHUP end a run in order.
#pragma once

#include "needlework/simulation.h"

namespace needlework::cli {

/// While it lives, the first of these signals interrupts the simulation instead of ending the
/// program. Another one ends it at once, but not within 0.2 s, as terminals, `timeout` and batch
/// systems often send the same signal twice. One guard at a time.
class SignalGuard {
 public:
  explicit SignalGuard(Simulation& simulation);
  /// Interrupts nothing: for those who ask received() often enough.
  SignalGuard();
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// The signal received, or 0.
  static int received();
};

}  // namespace needlework::cli
