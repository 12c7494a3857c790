// A run that has failed, run again from its bundle to show the failure.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "needlework/happening.h"
#include "src/runs/checkpoint.h"
#include "src/runs/prepared_run.h"

namespace needlework::runs {

/// What has happened, and which collision of the run it is, counted from 1; of an event of one
/// needle, the number of collisions before it.
struct NumberedHappening {
  std::uint64_t number = 0;
  Happening happening;
};

/// What came of a replay.
struct Replayed {
  Stop stop = Stop::time;
  std::optional<std::string> failure;  ///< none: nothing failed
  bool same = false;  ///< whether it failed as the run did: message, collisions and hash
  double time = 0;
  std::uint64_t collisions = 0;
  std::string trajectory_hash;
  /// The last collisions, and events of single needles, of the needles that the failure of the run
  /// is about, or of all needles if none are known.
  std::deque<NumberedHappening> last;
};

/// Runs from a bundle, or from any checkpoint, without output. Search, calendar, threads and
/// instruction set are those of the run, unless they are changed or missing on this machine.
class Replay {
 public:
  /// `last` is the number of collisions and events to remember; `change` may set the engine. Throws
  /// InputError for a file that is no bundle, and what complete_scene() throws, where the run
  /// starts from the initial.file of its scene.
  Replay(const std::string& path, std::size_t last, const std::function<void(Scene&)>& change = {});

  /// The failure of the run; none: the file is the checkpoint of a run that has not failed.
  const std::optional<RunFailure>& failure() const { return failure_; }
  const PreparedRun& run() const { return *run_; }
  PreparedRun& run() { return *run_; }
  double start_time() const { return start_time_; }
  std::uint64_t start_collisions() const { return start_collisions_; }

  /// Runs until something fails, or else to the collision after that at which the run failed, or to
  /// the end of a run that has not. To be called once.
  Replayed drive(RunMonitor& monitor);

 private:
  Scene::Until end() const;
  bool concerns(const Happening& happening) const;
  void note(const Happening& happening);

  std::size_t most_;
  std::optional<RunFailure> failure_;
  std::unique_ptr<PreparedRun> run_;
  double start_time_ = 0;
  std::uint64_t start_collisions_ = 0;
  std::uint64_t noted_ = 0;
  std::deque<NumberedHappening> last_;
};

}  // namespace needlework::runs
