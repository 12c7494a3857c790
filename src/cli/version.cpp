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
#ifdef NEEDLEWORK_MPI
  constexpr const char* mpi = "yes, needlework sweep runs under mpirun";
#else
  constexpr const char* mpi =
      "no: install section [mpi] of packages.txt, then configure and build again";
#endif
#ifdef NEEDLEWORK_PYTHON_VERSION
  constexpr const char* python = NEEDLEWORK_PYTHON_VERSION;
#else
  constexpr const char* python =
      "no: install section [python] of packages.txt, then configure and build again";
#endif
  return fmt::format(
      "needlework {}\ncompiler  {}\nflags     {}\nISA       {}\nHDF5      {}\nMPI       {}\n"
      "Python    {}",
      NEEDLEWORK_VERSION, compiler_name(), NEEDLEWORK_FLAGS,
      fmt::join(runs::instruction_sets(), " "), NEEDLEWORK_HDF5_VERSION, mpi, python);
}

}  // namespace needlework::cli
