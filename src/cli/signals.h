// SIGINT and SIGTERM end a run in order.
#pragma once

#include "needlework/simulation.h"

namespace needlework::cli {

/// While it lives, the first SIGINT or SIGTERM interrupts the simulation instead of ending the
/// program. Another one a second later, when saving hangs say, ends it at once; sooner ones are
/// taken for the same, as `timeout` and batch systems often send two. One guard at a time.
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
