// `needlework --version`.
#pragma once

#include <string>

namespace needlework::cli {

/// Version of the project, compiler, instruction sets and HDF5, a line each.
std::string version_text();

}  // namespace needlework::cli
