// `needlework info`.
#pragma once

#include <string>

namespace needlework::cli {

struct InfoArguments {
  std::string file;
};

/// Returns the exit code.
int run(const InfoArguments& arguments);

}  // namespace needlework::cli
