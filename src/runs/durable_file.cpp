#include "src/runs/durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "needlework/error.h"
#include "src/io/atomic_file.h"
#include "src/io/system_calls.h"
#include "src/machine/descriptors.h"

namespace needlework::runs {
namespace {

void require(const std::string& path, int error) {
  if (error == 0) return;
  throw IoError(fmt::format("{}: {}", path, std::generic_category().message(error)));
}

}  // namespace

void write_durably(const std::string& path, std::string_view bytes) {
  const int descriptor = open_descriptor(path, O_CREAT | O_TRUNC | O_WRONLY);
  if (descriptor < 0) require(path, errno);
  int error = io::write_fully(descriptor, bytes.data(), bytes.size(), 0);
  if (error == 0) error = io::sync_file(descriptor);
  const int closed = io::close_written(descriptor);
  if (error == 0) error = closed;
  if (error != 0) unlink(path.c_str());
  require(path, error);
}

void sync_bytes(const std::string& path) {
  const int descriptor = open_descriptor(path, O_RDONLY);
  if (descriptor < 0) require(path, errno);
  const int error = io::sync_file(descriptor);
  close(descriptor);
  require(path, error);
}

void rename_durably(const std::string& from, const std::string& to) {
  require(to, std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno);
  io::sync_name(to);
}

void replace_durably(const std::string& path, std::string_view bytes) {
  const std::string draft = path + ".part";
  write_durably(draft, bytes);
  rename_durably(draft, path);
}

}  // namespace needlework::runs
