// `needlework export`: needles as lines, for ParaView and VTK.
#pragma once

#include <string>

namespace needlework::cli {

struct ExportArguments {
  std::string from, to;
  bool force = false;
};

/// Returns the exit code.
int run(const ExportArguments& arguments);

}  // namespace needlework::cli
