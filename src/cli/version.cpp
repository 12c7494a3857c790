#include "src/cli/version.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/cli/engine_choice.h"

namespace needlework::cli {

std::string version_text() {
#if defined(__clang__)
  const std::string compiler = "Clang " __clang_version__;
#else
  const std::string compiler = "GCC " __VERSION__;
#endif
  return fmt::format("needlework {}\ncompiler  {}\nISA       {}\nHDF5      {}", NEEDLEWORK_VERSION,
                     compiler, fmt::join(instruction_sets(), " "), NEEDLEWORK_HDF5_VERSION);
}

}  // namespace needlework::cli
