// `needlework check`.
#pragma once

#include "src/cli/scene_arguments.h"

namespace needlework::cli {

struct CheckArguments {
  SceneArguments scene;
  bool json = false;
};

/// Returns the exit code.
int run(const CheckArguments& arguments);

}  // namespace needlework::cli
