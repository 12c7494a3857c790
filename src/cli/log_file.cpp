#include "src/cli/log_file.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "needlework/error.h"
#include "src/cli/json.h"
#include "src/cli/messages.h"

namespace needlework::cli {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

// A pipe is refused: the run would end with its reader.
bool can_be_a_log(const struct stat& status) {
  return S_ISREG(status.st_mode) || S_ISCHR(status.st_mode);
}

// The byte at this place, or 0.
char byte_at(int descriptor, off_t place) {
  char byte = 0;
  return pread(descriptor, &byte, 1, place) == 1 ? byte : '\0';
}

}  // namespace

LogFile::LogFile(const std::string& path, std::string place) : place_(std::move(place)) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && !can_be_a_log(status)) {
    throw IoError(place_ + ": cannot be written: expected an ordinary file");
  }
  descriptor_ = open(path.c_str(), O_CREAT | O_RDWR | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw IoError(fmt::format("{}: cannot be written: {}", place_, reason(errno)));
  }
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0) return;
  if (byte_at(descriptor_, 0) != '{') {
    close(descriptor_);
    throw IoError(place_ + ": holds something else: expected a new file, or a log to append to");
  }
  begins_line_ = byte_at(descriptor_, status.st_size - 1) == '\n';
}

LogFile::~LogFile() { close(descriptor_); }

void LogFile::write(std::string_view event, const nlohmann::ordered_json& keys) {
  nlohmann::ordered_json object{
      {"event", event}, {"at", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time({})))}};
  object.update(keys);
  const std::string line = (begins_line_ ? "" : "\n") + json_text(object) + "\n";
  ssize_t written = 0;
  do {
    written = ::write(descriptor_, line.data(), line.size());
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(line.size())) {
    begins_line_ = true;
    return;
  }
  const int error = written < 0 ? errno : ENOSPC;
  if (written > 0) begins_line_ = false;
  if (!std::exchange(has_warned_, true)) {
    print_warning(fmt::format("{}: lines are missing: {}", place_, reason(error)));
  }
}

}  // namespace needlework::cli
