// How a front end follows a run: it is shown the progress, and may stop it.
#pragma once

#include <span>

#include "needlework/totals.h"

namespace needlework::runs {

/// Implemented by front ends. All members are called by the thread that runs.
class RunMonitor {
 public:
  virtual ~RunMonitor() = default;

  /// The run is about to go on: the totals at its start, and the samples taken so far, which a run
  /// that is continued brings along.
  virtual void begin(const Totals& initial, std::span<const Totals> samples) {
    static_cast<void>(initial), static_cast<void>(samples);
  }
  /// Whether to show progress now, `elapsed` seconds of wall time into the run.
  virtual bool is_due(double elapsed) const = 0;
  /// `fraction` is the share done, in [0, 1]; the energy is that per needle at the start.
  virtual void show(double elapsed, double fraction, const Totals& now, double initial_energy) = 0;
  /// The run is over.
  virtual void clear() {}
  /// Whether to end the run; asked several times a second.
  virtual bool stop_requested() const { return false; }
};

}  // namespace needlework::runs
