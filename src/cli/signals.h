// SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2 and SIGXCPU end a run in order.
#pragma once

#include "needlework/simulation.h"

namespace needlework::cli {

/// While it lives, the first of these signals interrupts a simulation instead of ending the
/// program. Another one ends it at once, but not within 0.2 s, as terminals, `timeout` and batch
/// systems often send the same signal twice. SIGUSR1, SIGUSR2 and SIGXCPU, which come as warnings,
/// never end it at once, and one of the others after them counts as the first. One guard at a time.
class SignalGuard {
 public:
  /// Interrupts nothing yet: for those who ask received() often enough.
  SignalGuard();
  /// From now on a signal interrupts this simulation, which must outlive the guard; so does one
  /// that has come before.
  void interrupt(Simulation& simulation);
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// The signal received, or 0.
  static int received();
};

}  // namespace needlework::cli
