// `needlework run`.
#pragma once

#include <optional>
#include <string>

#include "src/cli/scene_arguments.h"

namespace needlework::cli {

struct RunArguments {
  SceneArguments scene;
  std::optional<std::string> out;
  bool json = false, quiet = false, watch = false, force = false;
};

/// Returns the exit code.
int run(const RunArguments& arguments);

}  // namespace needlework::cli
