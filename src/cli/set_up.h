// The time before a run: a signal, or the end of until.wall_s, ends it as well.
#pragma once

#include <optional>
#include <string>

#include "needlework/scene.h"
#include "src/cli/progress.h"
#include "src/machine/stop_request.h"

namespace needlework::cli {

/// While it lives, reading, drawing and sorting of the state throw StoppedEarly soon after a signal
/// has come (see SignalGuard), or when the limit on wall time has passed, which counts from the
/// launch of the program. To be ended before the run is driven.
class SetUp {
 public:
  /// `nothing_lost` ends the message: "stopped by a signal before the run began (...)".
  explicit SetUp(std::string nothing_lost);
  void limit(const Scene::Until& until) { wall_s_ = until.wall_s; }
  /// How far the placing of rods is will be shown, every so many seconds if that is given.
  void show_progress(std::optional<double> every) { line_.emplace(false, every); }

 private:
  std::string asked();
  std::string why() const;

  std::string nothing_lost_;
  std::optional<double> wall_s_;
  std::optional<ProgressLine> line_;
  const char* stage_ = nullptr;  ///< of the last call
  double stage_began_ = 0;       ///< seconds since the launch
  StopRequest request_;
};

}  // namespace needlework::cli
