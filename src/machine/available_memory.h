// How much memory the process can expect to get.
#pragma once

#include <filesystem>

namespace needlework {

/// Memory that the process can expect to get [bytes]: what the machine has available, or the limit
/// of a control group that the process is in if that is less. Infinity where neither is known.
/// `root` is where the file system begins, for tests.
double available_memory(const std::filesystem::path& root = "/");

}  // namespace needlework
