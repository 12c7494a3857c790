// `needlework audit`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "src/cli/scene_arguments.h"

namespace needlework::cli {

struct AuditArguments {
  SceneArguments scene;
  double share = 1;
  std::uint64_t seed = 0;
  std::optional<std::string> state;
  bool json = false, quiet = false;
};

/// Returns the exit code.
int run(const AuditArguments& arguments);

}  // namespace needlework::cli
