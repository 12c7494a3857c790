#include "src/runs/durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "needlework/error.h"

namespace needlework::runs {
namespace {

// Returns 0 or the errno of the failure.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = write(descriptor, bytes.data(), bytes.size());
    if (put < 0 && errno != EINTR) return errno;
    if (put == 0) return ENOSPC;
    if (put > 0) bytes.remove_prefix(static_cast<std::size_t>(put));
  }
  return fsync(descriptor) == 0 ? 0 : errno;
}

}  // namespace

void write_durably(const std::string& path, std::string_view bytes) {
  const int descriptor = open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666);
  int error = descriptor < 0 ? errno : write_all(descriptor, bytes);
  // Some file systems report a full disk only when a file is closed.
  if (descriptor >= 0 && close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0) return;
  if (descriptor >= 0) unlink(path.c_str());
  throw IoError(fmt::format("{}: {}", path, std::generic_category().message(error)));
}

void sync_folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace needlework::runs
