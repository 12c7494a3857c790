#include "src/cli/version.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/runs/engine_choice.h"

namespace needlework::cli {

std::string compiler_name() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

std::string version_text() {
  return fmt::format("needlework {}\ncompiler  {}\nflags     {}\nISA       {}\nHDF5      {}",
                     NEEDLEWORK_VERSION, compiler_name(), NEEDLEWORK_FLAGS,
                     fmt::join(runs::instruction_sets(), " "), NEEDLEWORK_HDF5_VERSION);
}

}  // namespace needlework::cli
