// `needlework run`.
#pragma once

#include <optional>
#include <string>

#include "src/cli/scene_arguments.h"
#include "src/cli/signals.h"
#include "src/runs/prepared_run.h"

namespace needlework::cli {

/// What to print of a run.
struct Printing {
  bool json = false, quiet = false, watch = false;
};

struct RunArguments {
  SceneArguments scene;
  std::optional<std::string> out;
  Printing printing;
  bool force = false;
};

/// Returns the exit code.
int run(const RunArguments& arguments);

/// Drives a run to its end, unless a signal ends it before, and prints the result. Returns the exit
/// code.
int drive(runs::PreparedRun& prepared, SignalGuard& signals, const Printing& printing);

}  // namespace needlework::cli
