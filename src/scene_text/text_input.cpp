#include "src/scene_text/text_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "needlework/error.h"
#include "src/machine/descriptors.h"
#include "src/scene/printable.h"

namespace needlework {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw IoError(fmt::format("{}: cannot be read: {}", printable(path), reason));
}

[[noreturn]] void fail(const std::string& path, int error) {
  fail(path, std::generic_category().message(error));
}

}  // namespace

std::unique_ptr<std::FILE, CloseFile> open_text(const std::string& path) {
  const int descriptor = open_descriptor(path, O_RDONLY | O_NONBLOCK);
  if (descriptor < 0) fail(path, errno);
  std::unique_ptr<std::FILE, CloseFile> file(fdopen(descriptor, "rb"));
  if (!file) {
    const int error = errno;
    close(descriptor);
    fail(path, error);
  }
  struct stat status {};
  if (fstat(descriptor, &status) != 0) fail(path, errno);
  if (S_ISDIR(status.st_mode)) fail(path, EISDIR);
  if (S_ISFIFO(status.st_mode)) {
    // Only reading tells whether there is a writer: without one the pipe ends at once.
    char first = 0;
    const ssize_t count = read(descriptor, &first, 1);
    if (count == 0) fail(path, "a pipe into which no program writes");
    if (count < 0 && errno != EAGAIN) fail(path, errno);
    if (count == 1) std::ungetc(static_cast<unsigned char>(first), file.get());
  }
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return file;
}

}  // namespace needlework
