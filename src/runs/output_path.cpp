#include "src/runs/output_path.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "needlework/error.h"
#include "src/runs/checkpoint.h"
#include "src/scene/check.h"
#include "src/scene/printable.h"

namespace needlework::runs {

void require_writable(const std::string& file, bool force, const std::string& place,
                      const char* option) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (file.find('\0') != std::string::npos) {
    throw IoError(printable(place) + ": cannot be written: expected a name without a zero byte");
  }
  const fs::path path(file);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw IoError(fmt::format("{}: cannot be written: expected a folder that exists, not {}", place,
                              folder.string()));
  }
  if (fs::exists(path, ignored)) {
    if (!fs::is_regular_file(path, ignored)) {
      throw IoError(place + ": cannot be written: expected an ordinary file");
    }
    if (!force) {
      const bool can_continue = CheckpointFiles(file).exist();
      throw IoError(fmt::format(
          "{}: exists already: expected a new file, or {} to replace it{}", place, option,
          can_continue ? "; the run in it can be continued by needlework resume" : ""));
    }
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw IoError(fmt::format("{}: cannot be written: expected permission to write in {}", place,
                              folder.string()));
  }
}

void require_other_file(const std::string& file, const std::string& input,
                        const std::string& place) {
  std::error_code ignored;
  if (!std::filesystem::equivalent(file, input, ignored)) return;
  throw IoError(fmt::format("{}: cannot be written: {} is read: expected another file", place,
                            printable(input)));
}

void require_writable_output(const Scene& scene, bool force, const std::string& scene_file,
                             const char* option) {
  const std::string& file = scene.output.file;
  if (file.empty()) return;
  const std::string place = place_of(scene, "output.file", file);
  require_writable(file, force, place, option);
  for (const std::string& read : {scene_file, scene.initial.file}) {
    if (!read.empty()) require_other_file(file, read, place);
  }
}

}  // namespace needlework::runs
