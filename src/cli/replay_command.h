// `needlework replay`: shows again how a run has failed.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "src/cli/scene_arguments.h"

namespace needlework::cli {

struct ReplayArguments {
  std::string bundle;
  std::size_t last = 10;  ///< number of collisions to print
  EngineOptions engine;
  bool json = false, quiet = false;
  std::optional<double> progress_every;  ///< [s]
};

/// Returns the exit code.
int run(const ReplayArguments& arguments);

}  // namespace needlework::cli
