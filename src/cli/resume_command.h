// `needlework resume`.
#pragma once

#include <string>
#include <vector>

#include "src/cli/run_command.h"
#include "src/cli/scene_arguments.h"

namespace needlework::cli {

struct ResumeArguments {
  std::string file;
  std::vector<std::string> overrides;  ///< of keys in [until]
  EngineOptions engine;
  Printing printing;
};

/// Returns the exit code.
int run(const ResumeArguments& arguments);

}  // namespace needlework::cli
