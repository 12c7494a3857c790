// `needlework run`.
#pragma once

#include <exception>
#include <optional>
#include <string>

#include "src/cli/run_log.h"
#include "src/cli/scene_arguments.h"
#include "src/cli/signals.h"
#include "src/runs/failure.h"
#include "src/runs/prepared_run.h"

namespace needlework::cli {

/// What to print of a run.
struct Printing {
  bool json = false, quiet = false, watch = false;
  std::optional<double> progress_every;  ///< interval of progress [s]
  std::optional<std::string> log;        ///< file
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
int drive(runs::PreparedRun& prepared, SignalGuard& signals, const Printing& printing, RunLog& log);

/// Calls action(), and logs the error that it ends with, if it does.
template <class Action>
int logged(RunLog& log, Action&& action) {
  try {
    return action();
  } catch (const std::exception&) {
    log.end(runs::current_failure());
    throw;
  }
}

/// The log that the options ask for, which must be another file than the output file.
RunLog open_log(const Printing& printing, const std::string& output_file);

}  // namespace needlework::cli
