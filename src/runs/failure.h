// What an exception means to those who run a scene: a message and an exit code.
#pragma once

#include <string>

#include "src/runs/exit_codes.h"

namespace needlework::runs {

struct Failure {
  ExitCode exit_code;
  std::string message;
};

/// That of the exception being handled; to be called in a catch block.
Failure current_failure();

}  // namespace needlework::runs
