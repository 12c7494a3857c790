// Advances a simulation with the output that its scene asks for: samples, frames, events.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "src/archive/archive.h"
#include "src/observe/batch_rate.h"
#include "src/observe/observation.h"
#include "src/observe/schedule.h"
#include "src/runs/pace.h"
#include "src/runs/resources.h"
#include "src/runs/run_monitor.h"

namespace needlework::runs {

/// How a run went.
struct RunResult {
  Totals initial, last;
  std::vector<Totals> samples;  ///< the series, first and last included
  Stop stop = Stop::time;
  std::optional<std::string> failure;  ///< the reason if the state became invalid
  std::string bundle;                  ///< file that `needlework replay` takes then, or empty
  Stopwatch setup;                     ///< time spent on the first search of all needles
  Stopwatch loop;                      ///< time spent in the event loop by this process
  std::uint64_t collisions = 0;        ///< in that time
  bool theory_holds = true;            ///< as long as no caller has replaced the velocities
  BatchRate::Estimate system_rate;     ///< collisions per time; only in equilibrium
};

/// Where the samples of a run go. With a writer there is an observation; a run without output can
/// be observed nevertheless, as one that is replayed is.
struct Output {
  io::Writer* writer = nullptr;
  observe::Observation* observation = nullptr;  ///< whose groups the writer was opened with
  std::function<void()> save_checkpoint = {};   ///< flushes the writer and saves the run
  bool saves_start = true;                      ///< whether before the first event, too
};

/// Advances a simulation in steps from sample to sample, and in short steps of wall time between
/// them. Neither changes the trajectory.
class RunDriver {
 public:
  /// Simulation, scene and output must live as long as the driver. `initial` are the totals at the
  /// start of the run. `keeps_result` says whether someone wants the samples and the rate of the
  /// RunResult; without that and without output, the driver takes no samples.
  RunDriver(Simulation& simulation, const Scene& scene, const Totals& initial, Output output,
            bool keeps_result);

  /// Advances until the first of the conditions is met or the monitor asks to stop. The conditions
  /// count from the start of the run, wall time from this call. Throws what Simulation::advance()
  /// throws, and IoError if the output cannot be written.
  Stop advance(const Scene::Until& until, RunMonitor& monitor);

  /// A caller has replaced all velocities, at the present time: the totals before and after. A
  /// sample or a frame that is due now and has not been taken holds the new velocities; of one that
  /// has been taken, a second one follows before the next event, or at the end.
  void velocities_set(const Totals& before, const Totals& after);
  /// Takes a sample now, and a frame if it is wanted, unless the same state has been sampled.
  /// Throws IoError.
  void sample_now(bool frame);

  /// Why the last advance ended.
  Stop stop() const { return result_.stop; }

  /// Saves or restores how far samples and frames have come, and the RunResult up to now.
  void transfer(Archive& archive);

  /// Writes and flushes the sample and the frame of the end. To be called once, at the end.
  RunResult finish();
  /// The same without sample and frame, for a state that is not sound.
  RunResult abandon();

  /// Saves the run, if the output does that, and says so to the monitor, if there is one.
  void save_checkpoint(RunMonitor* monitor);
  /// Whether nothing has happened since the last one of this process.
  bool is_saved() const;

  /// Sets a function that is called for all that happens, beside what the output needs; see
  /// Simulation::on_happening().
  void on_happening(std::function<void(const Happening&)> callback);

 private:
  using SteadyClock = std::chrono::steady_clock;

  bool samples() const { return output_.writer || output_.observation || keeps_result_; }
  void begin(RunMonitor* monitor);
  void schedule_if_set_in_motion();
  void record(const Happening& happening);
  void listen();
  void require_restored(const Archive& archive) const;
  std::optional<Stop> step(const Scene::Until& until, SteadyClock::time_point start);
  void sample(bool series, bool frame);
  bool is_sampled() const;
  bool has_frame() const;
  void sample_again();
  void take_last_totals();
  void flush();
  void flush_if_due();
  void save_checkpoint_if_due(RunMonitor& monitor);
  void show_progress(double elapsed, RunMonitor& monitor) const;

  Simulation& simulation_;
  const Scene& scene_;
  const Output output_;
  const bool keeps_result_;
  const std::uint64_t collisions_before_;  ///< by other processes
  bool begun_ = false;
  bool prepared_ = false;  ///< whether all needles have searched
  Schedule series_, frames_;
  std::optional<BatchRate> rate_;
  std::function<void(const Happening&)> callback_;
  std::exception_ptr failure_;  ///< of writing or observing an event
  RunResult result_;
  std::optional<Pace> pace_;  ///< of this advance, if someone follows it
  /// Time and collisions at the last checkpoint of this process.
  std::optional<std::pair<double, std::uint64_t>> saved_;
  std::optional<Totals> last_sample_;
  std::optional<double> last_frame_;  ///< time of the last frame written
  /// Whether velocities have been replaced since the last sample or the last frame.
  bool sample_is_old_ = false, frame_is_old_ = false;
  SteadyClock::time_point last_flush_ = SteadyClock::now();
  SteadyClock::time_point last_checkpoint_ = SteadyClock::now();
};

}  // namespace needlework::runs
