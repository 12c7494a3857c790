// Drives a simulation to its end: samples, output, progress.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "src/observe/batch_rate.h"
#include "src/observe/schedule.h"
#include "src/runs/resources.h"
#include "src/runs/run_monitor.h"

namespace needlework::runs {

/// How a run went.
struct Course {
  Totals initial, last;
  std::vector<Totals> samples;  ///< the series, first and last included
  Stop stop = Stop::time;
  std::optional<std::string> failure;  ///< the reason if the state became invalid
  Stopwatch loop;                      ///< time spent in the event loop
  BatchRate::Estimate system_rate;     ///< collisions per time; only in equilibrium
};

/// Runs a simulation until its scene says so, in steps from sample to sample, and in short steps of
/// wall time between them. Neither changes the trajectory.
class RunDriver {
 public:
  /// `writer` may be null. All must live as long as the driver.
  RunDriver(Simulation& simulation, const Scene& scene, io::Writer* writer, RunMonitor& monitor);

  /// Returns with everything written and flushed, also when the monitor asks to
  /// stop, at the limit of wall time and when the state has become invalid.
  Course run();

 private:
  double elapsed() const;
  void listen_to_collisions();
  void step_until_end();
  std::optional<Stop> step();
  void sample(bool series, bool frame);
  void sample_end();
  void keep_safe();
  void show_progress();

  Simulation& simulation_;
  const Scene& scene_;
  io::Writer* writer_;
  RunMonitor& monitor_;
  Schedule series_, frames_;
  std::optional<BatchRate> rate_;
  Course course_;
  std::chrono::steady_clock::time_point start_;
  double last_flush_ = 0;
  std::optional<double> last_frame_;  ///< time of the last frame written
};

}  // namespace needlework::runs
