// `needlework import`: scenes and states from the files of other programs.
#pragma once

#include <string>

namespace needlework::cli {

struct ImportArguments {
  std::string from;
  std::string folder;
  bool force = false;
};

/// Returns the exit code.
int run(const ImportArguments& arguments);

}  // namespace needlework::cli
