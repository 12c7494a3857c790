#include "src/runs/durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "needlework/error.h"
#include "src/io/system_calls.h"

namespace needlework::runs {
void write_durably(const std::string& path, std::string_view bytes) {
  const int descriptor = io::uninterrupted(
      [&] { return open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666); });
  int error = descriptor < 0 ? errno : io::write_fully(descriptor, bytes.data(), bytes.size(), 0);
  if (error == 0) error = io::sync_file(descriptor);
  if (descriptor >= 0) {
    const int closed = io::close_written(descriptor);
    if (error == 0) error = closed;
  }
  if (error == 0) return;
  if (descriptor >= 0) unlink(path.c_str());
  throw IoError(fmt::format("{}: {}", path, std::generic_category().message(error)));
}

}  // namespace needlework::runs
