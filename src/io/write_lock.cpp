#include "src/io/write_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <set>
#include <string_view>
#include <system_error>
#include <thread>

#include "needlework/error.h"
#include "src/io/hdf5.h"
#include "src/io/system_calls.h"
#include "src/machine/descriptors.h"

namespace needlework::io {
namespace {

[[noreturn]] void fail_lock(const std::string& place, int error) {
  throw IoError(fmt::format("{}: {}", place, std::generic_category().message(error)));
}

// What came of asking for a lock.
struct Answer {
  bool refused = false;  // someone else has a lock
  int absent = 0;        // why there are no locks here: an errno
};

// File systems without locks say so in many ways: ENOLCK, ENOSYS, EOPNOTSUPP, or 524 (ENOTSUPP),
// which is no errno of programs.
Answer answer(int result, bool refused) {
  if (result == 0) return {};
  return refused ? Answer{.refused = true} : Answer{.absent = errno};
}

// HDF5 takes a shared lock of this kind for reading and an exclusive one for writing. A shared one
// is therefore compatible with readers, but also with other locks of this class.
Answer lock_against_hdf5(int descriptor) {
  const int result = flock(descriptor, LOCK_SH | LOCK_NB);
  return answer(result, errno == EWOULDBLOCK);
}

// HDF5 does not know this kind of lock. It belongs to the open file and not to the process, so that
// it also excludes other writers of the same process.
Answer lock_against_writers(int descriptor) {
#ifdef F_OFD_SETLK
  struct flock whole_file {};
  whole_file.l_type = F_WRLCK;
  whole_file.l_whence = SEEK_SET;
  const int result = fcntl(descriptor, F_OFD_SETLK, &whole_file);
  return answer(result, errno == EAGAIN || errno == EACCES);
#else
  return {.absent = ENOSYS};
#endif
}

// What lock_against_writers() would say. A descriptor for reading is enough to ask.
Answer ask_for_writers(int descriptor) {
#ifdef F_OFD_GETLK
  struct flock whole_file {};
  whole_file.l_type = F_WRLCK;
  whole_file.l_whence = SEEK_SET;
  if (fcntl(descriptor, F_OFD_GETLK, &whole_file) != 0) return {.absent = errno};
  return {.refused = whole_file.l_type != F_UNLCK};
#else
  return {.absent = ENOSYS};
#endif
}

// The variable of HDF5 by which people turn locks off, or demand them. Read by HDF5 once.
std::string_view locking_wanted() {
  static const std::string wanted = [] {
    const char* const text = std::getenv("HDF5_USE_FILE_LOCKING");
    return std::string(text ? text : "");
  }();
  return wanted;
}

// Where locks are turned off, also answers nothing.
std::string reason_for(int absent) {
  if (locks_turned_off()) return fmt::format("HDF5_USE_FILE_LOCKING={}", locking_wanted());
  return fmt::format("the file system has no locks ({})", std::generic_category().message(absent));
}

constexpr const char* opened_elsewhere =
    ": another program or simulation has the file open for writing";

// Whether a lock stays refused for half a second. A program that has been killed may have just
// forked to read a file: that process has its locks until it runs, and closes them first of all.
template <class Refused>
bool stays_refused(Refused&& refused) {
  for (int tries = 0; refused(); ++tries) {
    if (tries == 50) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

// Those of all locks of the process. Used in a session, so that no other thread is about to change
// them when hdf5::fork_process() forks.
std::set<int>& descriptors() {
  static std::set<int>* const descriptors = new std::set<int>;
  return *descriptors;
}

}  // namespace

bool locks_turned_off() { return locking_wanted() == "FALSE" || locking_wanted() == "0"; }

LockState lock_state(int descriptor) {
  if (locks_turned_off()) return {.may_grow = true, .reason = reason_for(0)};
  const Answer writers = ask_for_writers(descriptor);
  const Answer hdf5 = lock_against_hdf5(descriptor);
  const int absent = hdf5.absent != 0 ? hdf5.absent : writers.absent;
  if (hdf5.absent == 0 && !hdf5.refused) flock(descriptor, LOCK_UN);
  return {.may_grow = writers.refused || absent != 0,
          .opened_to_write = writers.refused || hdf5.refused,
          .hdf5_can_lock = hdf5.absent == 0,
          .reason = absent == 0 ? "" : reason_for(absent)};
}

LockState lock_state(const std::string& name) {
  const int descriptor = open_descriptor(name, O_RDONLY | O_NONBLOCK);
  if (descriptor < 0) return {};
  LockState state = lock_state(descriptor);
  close(descriptor);
  return state;
}

void require_not_being_written(const std::string& name, const std::string& place) {
  if (lock_state(name).opened_to_write) throw IoError(place + opened_elsewhere);
}

std::string warning_without_locks(const std::string& name, const std::string& place) {
  const std::string reason = lock_state(name).reason;
  if (reason.empty()) return {};
  return fmt::format(
      "{}: {}, so that a second program that writes to it cannot be noticed: expected one at a "
      "time",
      place, reason);
}

WriteLock::WriteLock(const std::string& name, const std::string& place)
    : place_(place), descriptor_(open_descriptor(name, O_RDWR | O_NONBLOCK)) {
  if (descriptor_ < 0) fail_lock(place_, errno);
  struct stat status;
  const bool regular = fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  const auto refused = [&] {
    return !locks_turned_off() &&
           (lock_against_hdf5(descriptor_).refused || lock_against_writers(descriptor_).refused);
  };
  if (regular && !stays_refused(refused)) {
    const hdf5::Session session;
    descriptors().insert(descriptor_);
    return;
  }
  close(descriptor_);
  throw IoError(place_ + (regular ? opened_elsewhere : ": not a regular file"));
}

WriteLock::~WriteLock() {
  const hdf5::Session session;
  descriptors().erase(descriptor_);
  close(descriptor_);
}

void WriteLock::leave_to_parent() {
  for (const int descriptor : descriptors()) close(descriptor);
}

void WriteLock::sync() {
  if (const int error = sync_file(descriptor_)) fail_lock(place_, error);
}

void WriteLock::require_named(const std::string& name) const {
  struct stat locked, named;
  const bool same = fstat(descriptor_, &locked) == 0 && stat(name.c_str(), &named) == 0 &&
                    locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
  if (same) return;
  throw IoError(place_ + ": the file has been removed, renamed or replaced while it was written");
}

}  // namespace needlework::io
