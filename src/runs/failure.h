// What an exception means to those who use the program.
#pragma once

#include <string>

#include "src/runs/exit_codes.h"

namespace needlework::cli {

struct Failure {
  ExitCode exit_code;
  std::string message;
};

/// That of the exception being handled; to be called in a catch block.
Failure current_failure();

}  // namespace needlework::cli
