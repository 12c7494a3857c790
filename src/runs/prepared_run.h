// A run made ready to go: its simulation and its file.
#pragma once

#include <optional>
#include <string>

#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "src/runs/loaded_scene.h"
#include "src/runs/run_driver.h"

namespace needlework::runs {

/// Throws InputError, which names the scene by `path`, if nothing can ever happen and no end in
/// time is set.
void require_events(Simulation& simulation, const Scene& scene, const std::string& path);

/// Made of a scene; writes to its output.file if that is not empty.
class PreparedRun {
 public:
  /// `path` names the scene in messages; `force` replaces an existing file. Throws InputError if
  /// nothing can ever happen, and IoError if the file cannot be written.
  PreparedRun(LoadedScene loaded, bool force, const std::string& path);
  PreparedRun(const PreparedRun&) = delete;
  PreparedRun& operator=(const PreparedRun&) = delete;

  /// Runs to the end, to be called once; see RunDriver. Closes the file.
  Course drive(RunMonitor& monitor);

  const Scene& scene() const { return scene_; }
  Simulation& simulation() { return simulation_; }
  double setup_s() const { return setup_.wall(); }

 private:
  Simulation make_simulation(const LoadedScene& loaded);

  Scene scene_;
  Stopwatch setup_;
  Simulation simulation_;
  std::optional<io::Writer> writer_;
};

}  // namespace needlework::runs
