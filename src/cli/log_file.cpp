#include "src/cli/log_file.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>
#include <utility>

#include "needlework/error.h"
#include "src/cli/json.h"
#include "src/cli/messages.h"
#include "src/machine/descriptors.h"

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

// Whether what a file holds ends in the middle of a line; not known of a device.
bool ends_in_a_line(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0) {
    return false;
  }
  return byte_at(descriptor, status.st_size - 1) != '\n';
}

// Keeps out other processes that write to the same file, also from other machines where the network
// file system has locks. A run does not wait for its log: after a second it writes all the same.
class Turn {
 public:
  explicit Turn(int descriptor) : descriptor_(descriptor) {
    for (int tries = 0; tries < 1000; ++tries) {
      if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  ~Turn() { flock(descriptor_, LOCK_UN); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  int descriptor_;
};

}  // namespace

LogFile::LogFile(const std::string& path, std::string place) : place_(std::move(place)) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && !can_be_a_log(status)) {
    throw IoError(place_ + ": cannot be written: expected an ordinary file");
  }
  descriptor_ = open_descriptor(path, O_CREAT | O_RDWR | O_APPEND);
  if (descriptor_ < 0) {
    throw IoError(fmt::format("{}: cannot be written: {}", place_, reason(errno)));
  }
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0) return;
  if (byte_at(descriptor_, 0) != '{') {
    close(descriptor_);
    throw IoError(place_ + ": holds something else: expected a new file, or a log to append to");
  }
}

LogFile::~LogFile() { close(descriptor_); }

void LogFile::write(std::string_view event, const nlohmann::ordered_json& keys) {
  nlohmann::ordered_json object{
      {"event", event}, {"at", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time({})))}};
  object.update(keys);
  const Turn turn(descriptor_);
  const std::string line = (ends_in_a_line(descriptor_) ? "\n" : "") + json_text(object) + "\n";
  ssize_t written = 0;
  do {
    written = ::write(descriptor_, line.data(), line.size());
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(line.size())) return;
  const int error = written < 0 ? errno : ENOSPC;
  if (!std::exchange(has_warned_, true)) {
    print_warning(fmt::format("{}: lines are missing: {}", place_, reason(error)));
  }
}

}  // namespace needlework::cli
