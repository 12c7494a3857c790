#include "src/cli/output_path.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "src/error.h"

namespace needlework::cli {

void require_writable(const std::string& file, bool force) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path path(file);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw IoError(
        fmt::format("{}: cannot be written: there is no folder {}", file, folder.string()));
  }
  if (fs::exists(path, ignored)) {
    if (!fs::is_regular_file(path, ignored)) {
      throw IoError(file + ": cannot be written: it is not an ordinary file");
    }
    if (!force) {
      throw IoError(file + ": exists already: expected a new file, or --force to replace it");
    }
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw IoError(
        fmt::format("{}: cannot be written: no permission to write in {}", file, folder.string()));
  }
}

}  // namespace needlework::cli
