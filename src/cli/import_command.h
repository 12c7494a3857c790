// `needlework import`: scenes and states from the files of other programs.
#pragma once

#include <string>

namespace needlework::cli {

struct ImportArguments {
  std::string from;
  std::string folder;
  std::string frame = "last";  ///< or "first", or the number of one, from 0
  bool force = false;
};

/// Returns the exit code.
int run(const ImportArguments& arguments);

}  // namespace needlework::cli
