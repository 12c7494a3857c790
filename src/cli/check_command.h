// `needlework check`.
#pragma once

#include "src/runs/scene_source.h"

namespace needlework::cli {

struct CheckArguments {
  SceneArguments scene;
  bool json = false;
};

/// Returns the exit code.
int run(const CheckArguments& arguments);

}  // namespace needlework::cli
