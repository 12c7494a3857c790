#include "src/io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "needlework/error.h"
#include "src/io/system_calls.h"
#include "src/io/write_lock.h"
#include "src/machine/descriptors.h"

namespace needlework::io {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw IoError(fmt::format("{}: {}", path, reason));
}

[[noreturn]] void fail(const std::string& path, int error) {
  fail(path, std::generic_category().message(error));
}

[[noreturn]] void fail_existing(const std::string& path) {
  fail(path, "the file exists and is kept: expected a new name, or force to replace it");
}

// Renames unless `to` exists. Returns 0 or the errno of the failure.
int rename_if_new(const std::string& from, const std::string& to) {
#ifdef RENAME_NOREPLACE
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
#endif
  // Not every file system supports renameat2. A hard link is also made only if `to` is new.
  if (link(from.c_str(), to.c_str()) != 0) return errno;
  unlink(from.c_str());
  return 0;
}

std::string create_beside(const std::string& path, const std::filesystem::path& target) {
  for (int attempt = 0;; ++attempt) {
    const auto name = fmt::format(".needlework-{}-{}.part", getpid(), attempt);
    std::string temporary = (target.parent_path() / name).string();
    const int descriptor = open_descriptor(temporary, O_CREAT | O_EXCL | O_WRONLY);
    if (descriptor >= 0) {
      close(descriptor);
      return temporary;
    }
    if (errno != EEXIST) fail(path, errno);
  }
}

}  // namespace

AtomicFile::AtomicFile(std::string path, bool force)
    : path_(std::move(path)), target_(path_), force_(force) {
  if (path_.empty()) fail("''", "expected a file name");
  struct stat status;
  if (lstat(path_.c_str(), &status) == 0) {
    const bool link = S_ISLNK(status.st_mode);
    if (link && stat(path_.c_str(), &status) != 0) fail(path_, "the symbolic link leads nowhere");
    if (S_ISDIR(status.st_mode)) fail(path_, std::generic_category().message(EISDIR));
    if (!S_ISREG(status.st_mode)) fail(path_, "not a regular file");
    if (!force_) fail_existing(path_);
    if (link) target_ = std::filesystem::canonical(path_).string();
    require_not_being_written(target_, path_ + ": cannot be replaced");
  } else if (errno != ENOENT) {
    fail(path_, errno);
  }
  temporary_ = create_beside(path_, target_);
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::publish() {
  int error = 0;
  if (force_) {
    error = std::rename(temporary_.c_str(), target_.c_str()) == 0 ? 0 : errno;
  } else {
    error = rename_if_new(temporary_, target_);
  }
  if (error == EEXIST) fail_existing(path_);
  if (error != 0) fail(path_, error);
  temporary_.clear();
}

void sync_name(const std::string& path) {
  std::error_code error;
  const auto folder = std::filesystem::canonical(path, error).parent_path();
  if (error) fail(path, error.value());
  if (const int failure = sync_folder(folder)) fail(path, failure);
}

std::string absolute_name(const std::string& name) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(name, error);
  return error ? name : absolute.string();
}

std::string name_from_here(const std::string& absolute) {
  std::error_code error;
  const std::filesystem::path here = std::filesystem::current_path(error);
  if (error) return absolute;
  const std::filesystem::path name = std::filesystem::path(absolute).lexically_relative(here);
  return name.empty() || *name.begin() == ".." ? absolute : name.string();
}

}  // namespace needlework::io
