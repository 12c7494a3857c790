// Where Linux keeps the limits of the control groups that a process is in.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace needlework {

/// The folders of the process's control group and of all groups that contain it, the innermost
/// first, in each mounted hierarchy that has this controller of version 1 ("cpu", "memory") and in
/// that of version 2. Containers see a part of a hierarchy only, which their mounts say. `root` is
/// where the file system begins, for tests.
std::vector<std::filesystem::path> control_groups(const std::string& controller,
                                                  const std::filesystem::path& root = "/");

}  // namespace needlework
