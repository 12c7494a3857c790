// `needlework --version`.
#pragma once

#include <string>

namespace needlework::cli {

/// Such as "GCC 12.2.0".
std::string compiler_name();

/// Version of the project, compiler and its flags, instruction sets and HDF5, a line each.
std::string version_text();

}  // namespace needlework::cli
