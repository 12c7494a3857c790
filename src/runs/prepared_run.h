// A run made ready to go: its simulation and the output that its scene asks for.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "needlework/user_data.h"
#include "src/observe/observation.h"
#include "src/runs/batches.h"
#include "src/runs/checkpoint.h"
#include "src/runs/limits.h"
#include "src/runs/loaded_scene.h"
#include "src/runs/run_driver.h"

namespace needlework::runs {

/// Throws InputError, which names the scene by `path`, if the run would never end: nothing can ever
/// happen and no end in time is set, or collisions keep the energy and no other end is set.
void require_events(const LoadedScene& loaded, const std::string& path);

/// What front ends say where a caller sets velocities alone.
inline constexpr const char* no_rotation_given =
    "angular_velocity: not given: those of all needles are 0 now";

/// When a run with an output file is saved, besides every output.checkpoint_every.
enum class Saves {
  start_and_end,  ///< so that a run can be continued beyond its end, too
  when_stopped,   ///< before its end: for many short runs
};

/// Made of a scene; writes to its output.file if that is not empty. A front end either drives it to
/// the end that the scene sets, or advances it piece by piece.
class PreparedRun {
 public:
  /// For drive(): `path` names the scene in messages; `force` replaces an existing file. Throws
  /// InputError if the run would never end, and IoError if the file cannot be written.
  PreparedRun(LoadedScene loaded, bool force, const std::string& path,
              Saves saves = Saves::start_and_end);
  /// For advance(): takes samples for the output file only.
  PreparedRun(LoadedScene loaded, bool force);
  /// Continues a run, with the output file that its scene names, or without output if it names
  /// none; then its RunResult has no samples and no rate. Throws InputError if the file is not that
  /// of the run, and IoError if it cannot be written.
  explicit PreparedRun(RunCheckpoint saved, Saves saves = Saves::start_and_end);
  PreparedRun(const PreparedRun&) = delete;
  PreparedRun& operator=(const PreparedRun&) = delete;

  /// Runs to the end, to be called once; see RunDriver. Closes the file. Catches what makes a run
  /// invalid, InvalidStateError and defects of the program: the message is in the RunResult, and a
  /// bundle is beside the output file, if there is one. `spent`: wall time that has passed of
  /// until.wall_s [s].
  RunResult drive(RunMonitor& monitor, double spent = 0);

  /// Advances until the first of the conditions is met, which count from the start of the run. The
  /// functions of on_collisions() and on_happenings() have seen all that has happened when this
  /// returns or throws. Throws what
  /// RunDriver::advance() throws, and else what such a function has thrown. Defects of the program
  /// become an UnfinishedEventError. The message of an InvalidStateError names the bundle that has
  /// been written beside the output file, if there is one.
  Stop advance(const Scene::Until& until, RunMonitor& monitor);
  /// Sets a function that is given all collisions in order of time, `batch` at once, and at the end
  /// of each advance those that are left; see Batches. None ends it.
  void on_collisions(std::size_t batch, Batches<Collision>::Callback callback);
  /// The same for all that happens: collisions, and events of single needles such as hits on walls.
  void on_happenings(std::size_t batch, Batches<Happening>::Callback callback);
  /// Replaces all velocities at the present time; see Simulation::set_velocities(). The output file
  /// says when, and by how much the energy changed; kinetic theory is left out of it from then on.
  void set_velocities(std::span<const std::array<double, 3>> velocity,
                      std::span<const std::array<double, 3>> angular_velocity);
  /// When that was done for the first time; none: never.
  std::optional<double> velocities_set() const { return velocities_set_; }
  /// Adds a sample of the present state to the output file, and a frame if it is wanted, unless
  /// the file has just got them. Throws IoError; to be called with an open file only.
  void sample(bool frame);
  /// Sets a value of the user's own, which checkpoints, and the output file, carry; none: removes
  /// it. Throws InputError for what cannot be carried, JSON that is none included.
  void set_data(const std::string& name, std::optional<UserData> data);
  const UserDataByName& data() const { return data_; }

  /// Saves the run beside its output file, if it has one and checkpoints are on, so that it can be
  /// continued from here. Throws IoError.
  void save_checkpoint();
  /// Why there is no output file to write to, and what was expected; empty if there is one.
  std::string why_no_output() const;
  /// Why save_checkpoint() does nothing, and what was expected; empty if it saves.
  std::string why_not_saved() const;
  /// Saves the run, writes the sample and the frame of the end, and closes the file. Then only
  /// the simulation may be used, and others may continue the file, also where this throws IoError.
  /// Does nothing when called again. Without it, and after an error in the middle of an event, the
  /// file ends with the last sample that was due.
  void close();

  const Scene& scene() const { return scene_; }
  Simulation& simulation() { return simulation_; }
  const Simulation& simulation() const { return simulation_; }
  /// Time spent on making the simulation, without the first search of its needles [s].
  double setup_s() const { return setup_.wall(); }
  /// A warning about the output file: that other programs which write to it cannot be noticed.
  /// Empty if there is none.
  std::string warning() const;

 private:
  PreparedRun(LoadedScene loaded, bool force, bool keeps_result, Saves saves);
  Simulation make_simulation(const LoadedScene& loaded);
  Simulation continue_simulation(const RunCheckpoint& saved);
  /// Throws InputError unless the parts of the checkpoint belong together.
  void require_consistent(const RunCheckpoint& saved) const;
  /// Restores what observables and schedules remember. Throws InputError if it is damaged.
  void restore(const RunCheckpoint& saved, RunDriver& driver);
  template <class Open>
  void open_output(Open&& open);
  void observe();
  Output output();
  void save_checkpoint(CheckpointFiles::Newest present);
  struct Kept;
  Kept keep_failure(const std::string& message, const InvalidStateError::Needles& needles);
  Kept keep_current_failure();
  void listen();
  std::exception_ptr error_for_caller();
  void write_bundle(const RunFailure& failure);
  std::optional<RunCheckpoint> before_failure() const;
  CheckpointFiles checkpoints() const;

  const pid_t process_ = getpid();
  Scene scene_;
  Saves saves_;
  std::string output_file_;  ///< absolute, as the process may go to another folder
  bool cut_off_ = false;     ///< whether an event was, by an error in the middle of it
  bool drawn_;               ///< whether the initial state was drawn
  std::optional<double> velocities_set_;
  bool set_since_saved_ = false;  ///< whether velocities were, since the last checkpoint
  UserDataByName data_;
  Stopwatch setup_;
  Simulation simulation_;
  Totals initial_;                                   ///< at the start of the run
  std::optional<observe::Observation> observation_;  ///< if there is a writer, or has been one
  std::optional<io::Writer> writer_;
  std::optional<RunDriver> driver_;
  std::optional<Batches<Collision>> collisions_;
  std::optional<Batches<Happening>> happenings_;
};

}  // namespace needlework::runs
