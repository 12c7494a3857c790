// `needlework --version`.
#pragma once

#include <string>

namespace needlework::cli {

/// Such as "GCC 12.2.0".
std::string compiler_name();

/// Version of the project, compiler and its flags, instruction sets HDF5, and whether MPI
/// and Python are in the build, a line each.
std::string version_text();

}  // namespace needlework::cli
