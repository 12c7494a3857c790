// How a front end follows a run: it is shown the progress, and may stop it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "needlework/totals.h"

namespace needlework::runs {

/// How far a run is.
struct Progress {
  double elapsed = 0;   ///< wall time in which this process has run it [s]
  double fraction = 0;  ///< share done, in [0, 1]
  double left = 0;      ///< wall time to its end at the pace so far, infinite if not known [s]
  double rate = 0;      ///< collisions in this process per second of wall time
  Totals now, initial;  ///< `initial`: at the start of the run
  std::optional<GrowthTotals> growth = {};  ///< where bodies grow
  double energy_drift = 0;                  ///< see Simulation::energy_drift()
  double momentum_drift = 0;  ///< change of the total momentum, over sqrt(N m T_tr); NaN where
                              ///< walls or a thermostat change it
  /// Wall time since the last checkpoint, or since this process has begun; none if none is written
  /// [s].
  std::optional<double> since_checkpoint = {};
};

/// Implemented by front ends. All members are called by the thread that runs.
class RunMonitor {
 public:
  virtual ~RunMonitor() = default;

  /// The run is about to go on: the totals at its start, the samples taken so far, which a run
  /// that is continued brings along, and whether kinetic theory has something to say of it: not
  /// once a caller has replaced its velocities.
  virtual void begin(const Totals& initial, std::span<const Totals> samples, bool theory_holds) {
    static_cast<void>(initial), static_cast<void>(samples), static_cast<void>(theory_holds);
  }
  /// Whether to show progress now, `elapsed` seconds of wall time into the run; at infinity,
  /// whether it is ever shown.
  virtual bool is_due(double elapsed) const = 0;
  virtual void show(const Progress& progress) = 0;
  /// A checkpoint of this time and number of collisions has been written, in so many seconds.
  virtual void saved(double time, std::uint64_t collisions, double seconds) {
    static_cast<void>(time), static_cast<void>(collisions), static_cast<void>(seconds);
  }
  /// The run is over.
  virtual void clear() {}
  /// Whether to end the run; asked several times a second.
  virtual bool stop_requested() const { return false; }
};

}  // namespace needlework::runs
